// Shape matching on a lattice with holes, by brute force over the nodes inside a window and from positions instead of
// displacements.
#pragma once
#include <Eigen/Dense>
#include <functional>

#include "kernels/matching/flsm_case.h"

namespace pliant::kernel_test {

using Offset = std::array<int, 3>;
constexpr Offset down_order{2, 1, 0};  ///< from a region's centre to its nodes: z, y, x
constexpr Offset up_order{0, 1, 2};    ///< from a node to the regions that hold it: x, y, z
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The rotation nearest to a: U V^T of its singular value decomposition, the smallest direction turned where that is a
/// reflection.
inline Matrix3d nearest_rotation(const Matrix3d& a) {
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() > 0 ? 1 : -1);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

inline Vector3d vector_at(const Reals& values, std::size_t at) { return {values[at], values[at + 1], values[at + 2]}; }

inline void put(Reals& values, std::size_t at, const Vector3d& v) {
  for (std::size_t c = 0; c < 3; ++c) values[at + c] = v[static_cast<Eigen::Index>(c)];
}

/// The part of psi(e) that goes with shear (host/model/matching/flsm_elastic.cpp).
inline double energy_of(const Matrix3d& e) {
  const Matrix3d e2 = e * e;
  const double y = std::min(1.0, PLIANT_FLSM_STRAIN / e2.trace()), k = y * (2 - y);
  return e2.trace() / 2 - k * (e2 * e).trace() / 6 + k * k * (e2 * e2).trace() / 32;
}

inline Matrix3d slope_of(const Matrix3d& e) {
  Matrix3d slope;
  for (int k = 0; k < 9; ++k) {
    const double d = 1e-4 * (1 + e.norm());
    Matrix3d by = Matrix3d::Zero();
    by(k / 3, k % 3) += 0.5, by(k % 3, k / 3) += 0.5;  // both of an off-diagonal pair
    const auto at = [&](double t) { return energy_of(e + t * d * by); };
    slope(k / 3, k % 3) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * d);
  }
  return slope;
}

/// Nodes of a box of the grid, a share `holes` of them missing. A region holds the nodes inside its window; where there are
/// holes, some of them by no path along x, y and z, and some that are on such a path it does not hold: any relation will do for
/// the kernels.
class FlsmLattice {
 public:
  static constexpr double spacing = 0.02;

  FlsmLattice(Random& random, const Offset& size, double holes, int width) : size_(size), width_(width) {
    index_.assign(static_cast<std::size_t>(size[0] * size[1] * size[2]), -1);
    for (std::size_t cell = 0; cell < index_.size(); ++cell) {
      if (random.chance(holes)) continue;
      index_[cell] = nodes();
      const int c = static_cast<int>(cell);
      place_.push_back({c % size[0], c / size[0] % size[1], c / size[0] / size[1]});
      mass_.push_back(random.uniform(0.5, 2));
    }
    const Matrix3d turn = nearest_rotation(Matrix3d::NullaryExpr([&] { return random.uniform(-1, 1); }));
    for (const Offset& at : place_) {
      const Vector3d x = spacing * Vector3d(at[0], at[1], at[2]);
      const Vector3d noise = 0.3 * spacing * Vector3d::NullaryExpr([&] { return random.uniform(-1, 1); });
      u_.push_back(turn * x - x + Vector3d(0.3, -0.1, 0.2) + noise);
    }
  }

  /// Another field of displacements, or of increments: a function of the position at rest.
  void set_u(const std::function<Vector3d(const Vector3d&)>& field) {
    for (int i = 0; i < nodes(); ++i) u_[static_cast<std::size_t>(i)] = field(rest(i));
  }

  void set_u(const std::function<Vector3d(int)>& of_node) {
    std::vector<Vector3d> all;
    for (int i = 0; i < nodes(); ++i) all.push_back(of_node(i));
    u_ = std::move(all);
  }

  [[nodiscard]] int nodes() const { return static_cast<int>(place_.size()); }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] double mass(int i) const { return mass_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Vector3d& u(int i) const { return u_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Vector3d rest(int i) const {
    const Offset& at = place_[static_cast<std::size_t>(i)];
    return spacing * Vector3d(at[0], at[1], at[2]);
  }
  /// The node at an offset from node i, or -1.
  [[nodiscard]] int at(int i, const Offset& o) const {
    Offset p = place_[static_cast<std::size_t>(i)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] += o[axis];
      if (p[axis] < 0 || p[axis] >= size_[axis]) return -1;
    }
    return index_[static_cast<std::size_t>((p[2] * size_[1] + p[1]) * size_[0] + p[0])];
  }
  /// Whether the region of node i holds the node at an offset.
  [[nodiscard]] bool holds(int i, const Offset& o) const {
    const int node = at(i, o);
    return node >= 0 && (node == i || !has_holes() || (7 * i + 13 * node) % 11 != 0);
  }
  [[nodiscard]] bool has_holes() const { return place_.size() < index_.size(); }
  /// The same as at() along links, the axes in the given order: -1 where a node on the way is missing.
  [[nodiscard]] int walk(int i, const Offset& o, const Offset& order) const {
    for (const int axis : order) {
      const auto a = static_cast<std::size_t>(axis);
      for (int k = 0; k < std::abs(o[a]) && i >= 0; ++k) {
        Offset one{};
        one[a] = o[a] < 0 ? -1 : 1;
        i = at(i, one);
      }
    }
    return i;
  }
  /// Calls with each offset in the window of half-widths (1 or 0 times the width) along x, y, z.
  void for_window(bool x, bool y, bool z, const std::function<void(const Offset&)>& visit) const {
    const int wx = x ? width_ : 0, wy = y ? width_ : 0, wz = z ? width_ : 0;
    for (int oz = -wz; oz <= wz; ++oz) {
      for (int oy = -wy; oy <= wy; ++oy) {
        for (int ox = -wx; ox <= wx; ++ox) visit({ox, oy, oz});
      }
    }
  }

  /// Links, lists and rest data of every region as the program gives them; sums and records are zero.
  [[nodiscard]] FlsmData data() const;
  /// Moments sum m u / spacing of the nodes that bars (x) or plates (x, y) reach, and those times o_x, o_y.
  [[nodiscard]] Reals moments(bool y, std::size_t stride) const;

 private:
  void fill_rest(FlsmData& d, int i) const;

  Offset size_;
  int width_;
  std::vector<int> index_;
  std::vector<Offset> place_;
  std::vector<double> mass_;
  std::vector<Vector3d> u_;
};

inline FlsmData FlsmLattice::data() const {
  FlsmData d;
  const auto n = static_cast<std::size_t>(nodes());
  const std::size_t count = (n + PLIANT_TILE) / PLIANT_TILE * PLIANT_TILE;  // at least one region that stands for absent ones
  d.exact = true;
  d.count = count;
  d.spacing = spacing;
  d.slot.assign(count, 0);
  d.node_u.assign(4 * count, 0);
  d.node_w.assign(4 * count, 0);
  d.weight.assign(count, 0);
  d.bars.assign(8 * count, 0);
  d.plates.assign(PLIANT_FLSM_RECORD * count, 0);
  d.regions.assign(PLIANT_FLSM_RECORD * count, 0);
  d.rest.assign(PLIANT_FLSM_REST_PLANES * count, 0);
  d.inverse_holders.assign(count, 0);
  for (auto& link : d.link) link.assign(2 * count, nodes());
  for (std::size_t i = 0; i < count; ++i) d.slot[i] = static_cast<int>(count - 1 - i);  // not the order of the regions
  d.missing_offset = d.missing_of_offset = {0};
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const auto r = static_cast<std::size_t>(i);
    if (i < nodes()) {
      d.weight[r] = mass(i) / spacing;
      put(d.node_u, 4 * static_cast<std::size_t>(d.slot[r]), u(i));
      int holders = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
          Offset one{};
          one[axis] = 2 * side - 1;
          if (at(i, one) >= 0) d.link[axis][2 * r + static_cast<std::size_t>(side)] = at(i, one);
        }
      }
      for_window(true, true, true, [&](const Offset& o) {
        const int other = at(i, o);
        if (other < 0) return;
        const bool held = holds(other, {-o[0], -o[1], -o[2]});
        if (held) ++holders;
        const int lacks = int{holds(i, o)} - int{walk(i, o, down_order) >= 0};
        const int lacks_of = int{held} - int{walk(i, o, up_order) >= 0};
        const double weight = lacks * mass(other) / spacing;
        if (lacks != 0) {
          d.missing.push_back(d.slot[static_cast<std::size_t>(other)]);
          d.missing_factor.insert(d.missing_factor.end(), {weight, weight * o[0], weight * o[1], weight * o[2]});
        }
        if (lacks_of != 0) {
          d.missing_of.push_back(other);
          for (const int f : {1, -o[0], -o[1], -o[2]}) d.missing_of_factor.push_back(lacks_of * f);
        }
      });
      d.inverse_holders[r] = 1.0 / holders;
      fill_rest(d, i);
    }
    d.missing_offset.push_back(static_cast<int>(d.missing.size()));
    d.missing_of_offset.push_back(static_cast<int>(d.missing_of.size()));
  }
  d.missing.push_back(0);  // never empty
  d.missing_of.push_back(0);
  d.missing_factor.resize(4 * d.missing.size(), 99);
  d.missing_of_factor.resize(4 * d.missing_of.size(), 99);
  return d;
}

inline void put_rest(Reals& rest, std::size_t region, double inverse, const Vector3d& center, const Matrix3d& a) {
  const double plane[PLIANT_FLSM_REST_PLANES] = {inverse, center[0], center[1], center[2], a(0, 0),
                                                 a(1, 1), a(2, 2),   a(0, 1),   a(0, 2),   a(1, 2)};
  const std::size_t base = region / PLIANT_TILE * PLIANT_FLSM_REST_PLANES * PLIANT_TILE + region % PLIANT_TILE;
  for (std::size_t p = 0; p < PLIANT_FLSM_REST_PLANES; ++p) rest[base + p * PLIANT_TILE] = plane[p];
}

inline void FlsmLattice::fill_rest(FlsmData& d, int i) const {
  double sum = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for_window(true, true, true, [&](const Offset& o) {
    if (!holds(i, o)) return;
    const int node = at(i, o);
    const Vector3d offset(o[0], o[1], o[2]);
    sum += mass(node);
    first += mass(node) * offset;
    second += mass(node) * offset * offset.transpose();
  });
  put_rest(d.rest, static_cast<std::size_t>(i), spacing / sum, first / sum, second - first * first.transpose() / sum);
}

inline Reals FlsmLattice::moments(bool y, std::size_t stride) const {
  const FlsmData d = data();
  Reals result(stride * d.count, 0.0);
  for (int i = 0; i < nodes(); ++i) {
    Vector3d sum[3] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    for_window(true, y, false, [&](const Offset& o) {
      const int node = walk(i, o, down_order);
      if (node < 0) return;
      const Vector3d mu = mass(node) / spacing * u(node);
      sum[0] += mu;
      sum[1] += o[0] * mu;
      sum[2] += o[1] * mu;
    });
    for (std::size_t k = 0; k < (y ? 3U : 2U); ++k) put(result, stride * static_cast<std::size_t>(i) + 4 * k, sum[k]);
  }
  return result;
}

/// Random records t, h D e_x, h D e_y, h D e_z of the nodes' regions; zero for the absent ones.
inline Reals random_records(Random& random, const FlsmLattice& lattice, std::size_t count) {
  Reals records(PLIANT_FLSM_RECORD * count, 0.0);
  for (std::size_t k = 0; k < PLIANT_FLSM_RECORD * static_cast<std::size_t>(lattice.nodes()); ++k) {
    records[k] = k % 4 == 3 ? 0 : random.uniform(-0.02, 0.02);
  }
  return records;
}

inline Vector3d record_block(const Reals& records, int region, std::size_t block) {
  return vector_at(records, PLIANT_FLSM_RECORD * static_cast<std::size_t>(region) + 4 * block);
}

/// What is left of the goals of node i after the passes along z (and y): sums over the regions that it reaches along these axes
/// of t and the terms of these axes, and of the columns h D e_x (and h D e_y) that wait.
struct GoalSums {
  Vector3d t = Vector3d::Zero(), x = Vector3d::Zero(), y = Vector3d::Zero();
};

inline GoalSums goal_sums(const FlsmLattice& lattice, const Reals& records, int i, bool along_y) {
  GoalSums sums;
  lattice.for_window(false, along_y, true, [&](const Offset& o) {
    const int region = lattice.walk(i, o, up_order);
    if (region < 0) return;
    sums.t += record_block(records, region, 0) - o[2] * record_block(records, region, 3);
    if (along_y) sums.t -= o[1] * record_block(records, region, 2);
    sums.x += record_block(records, region, 1);
    sums.y += record_block(records, region, 2);
  });
  return sums;
}

/// The mean of T X - X over the regions that hold node i.
inline Vector3d mean_goal(const FlsmLattice& lattice, const Reals& records, int i) {
  Vector3d sum = Vector3d::Zero();
  int holders = 0;
  lattice.for_window(true, true, true, [&](const Offset& o) {
    const int region = lattice.at(i, o);
    if (region < 0 || !lattice.holds(region, {-o[0], -o[1], -o[2]})) return;
    ++holders;
    sum += record_block(records, region, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) sum -= o[axis] * record_block(records, region, axis + 1);
  });
  return sum / holders;
}

/// Records, and the sums along z and y that the passes before leave: what goal_sum reads.
inline FlsmData goal_data(Random& random, const FlsmLattice& lattice) {
  FlsmData d = lattice.data();
  d.regions = random_records(random, lattice, d.count);
  for (int i = 0; i < lattice.nodes(); ++i) {
    const GoalSums sums = goal_sums(lattice, d.regions, i, true);
    put(d.bars, 8 * static_cast<std::size_t>(i), sums.t);
    put(d.bars, 8 * static_cast<std::size_t>(i) + 4, sums.x);
  }
  return d;
}

/// Lattices full and with holes, of all widths.
inline std::vector<FlsmLattice> lattices(Random& random) {
  std::vector<FlsmLattice> all;
  for (int width = 1; width <= 5; ++width) {
    for (const double holes : {0.0, 0.15}) all.emplace_back(random, Offset{7, 5, 6}, holes, width);
  }
  return all;
}

inline void expect_near(const Vector3d& expected, const Reals& values, std::size_t at, double tolerance,
                        const std::string& what) {
  EXPECT_LE((vector_at(values, at) - expected).norm(), tolerance)
      << what << ": expected " << expected.transpose() << ", received " << vector_at(values, at).transpose();
}

/// Mass, centroids at rest and now, and the moments of the nodes that a region holds.
struct RegionSums {
  double mass = 0;
  Vector3d rest = Vector3d::Zero(), now = Vector3d::Zero();
  Matrix3d moved = Matrix3d::Zero(), at_rest = Matrix3d::Zero();
};

inline RegionSums sums_of(const FlsmLattice& lattice, int i) {
  RegionSums s;
  for (const bool centred : {false, true}) {
    lattice.for_window(true, true, true, [&](const Offset& o) {
      if (!lattice.holds(i, o)) return;
      const int node = lattice.at(i, o);
      const double m = lattice.mass(node);
      const Vector3d rest = lattice.rest(node), x = rest + lattice.u(node);
      if (!centred) {
        s.mass += m;
        s.rest += m * rest;
        s.now += m * x;
        return;
      }
      s.moved += m * (x - s.now) * (rest - s.rest).transpose();
      s.at_rest += m * (rest - s.rest) * (rest - s.rest).transpose();
    });
    if (centred) break;
    s.rest /= s.mass;
    s.now /= s.mass;
  }
  return s;
}

}  // namespace pliant::kernel_test
