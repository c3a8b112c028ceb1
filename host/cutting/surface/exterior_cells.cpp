#include "cutting/surface/exterior_cells.h"

#include <Eigen/Dense>
#include <algorithm>
#include <set>

#include "geometry/disjoint_sets.h"

namespace pliant::overlay {
namespace {

constexpr int kReach = 2;              // a block holds the cells around a corner up to this distance
constexpr int kSide = 2 * kReach + 1;  // corners along one side
constexpr double kLeast = 0.02;        // of an edge in air, between a cut and an end

GridIndex sum(const GridIndex& a, const GridIndex& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

}  // namespace

// The corners around one corner: which of them material of the lattice joins inside the block, and the plane of the cut there.
struct ExteriorCells::Block {
  std::array<std::int16_t, kSide * kSide * kSide> joined{};  // -1: no cell of the lattice has the corner
  std::array<double, kSide * kSide * kSide> side{};          // of a set: mean distance of its corners from the plane
  bool plane = false;
  Vec3d normal{}, middle{};
  GridIndex centre{};

  [[nodiscard]] int at(const GridIndex& corner) const {
    return ((corner[2] - centre[2] + kReach) * kSide + corner[1] - centre[1] + kReach) * kSide + corner[0] - centre[0] + kReach;
  }
  [[nodiscard]] double distance(const Vec3d& x) const { return vec::dot(normal, vec::sub(x, middle)); }
};

ExteriorCells::ExteriorCells(const SurfaceSource& source, const std::vector<std::int32_t>& cell_at)
    : source_(source), cell_at_(cell_at) {}
ExteriorCells::~ExteriorCells() = default;

std::int32_t ExteriorCells::lattice_cell(const GridIndex& cell) const {
  for (int a = 0; a < 3; ++a) {
    if (cell[a] < 0 || cell[a] >= source_.grid().size[a]) return -1;
  }
  return cell_at_[source_.grid().number(cell)];
}

const CutGridCell* ExteriorCells::cut_cell(const GridIndex& cell) const {
  const auto found = cut_.find(source_.grid().number(cell));
  return found == cut_.end() ? nullptr : &found->second;
}

const ExteriorCells::Block& ExteriorCells::block(const GridIndex& centre) {
  const auto [found, is_new] = blocks_.try_emplace(source_.grid().number(centre));
  Block& block = found->second;
  if (!is_new) return block;
  block.centre = centre;
  std::array<char, kSide * kSide * kSide> present{};
  DisjointSets sets(present.size());
  std::vector<Vec3d> points;
  for (int k = -kReach; k < kReach; ++k) {
    for (int j = -kReach; j < kReach; ++j) {
      for (int i = -kReach; i < kReach; ++i) {
        const GridIndex cell = sum(centre, {i, j, k});
        if (lattice_cell(cell) < 0) continue;
        const CutGridCell* cut = cut_cell(cell);
        std::array<int, 8> first{};
        first.fill(-1);
        for (int c = 0; c < 8; ++c) {
          const int here = block.at(corner_index(cell, c)), label = cut == nullptr ? 0 : cut->label[c];
          present[here] = 1;
          if (first[label] < 0) first[label] = here;
          sets.join(first[label], here);
        }
        for (std::size_t e = 0; e < kKuhnEdges.size() && cut != nullptr; ++e) {
          const auto [a, b] = kKuhnEdges[e];
          if (cut->label[a] == cut->label[b]) continue;
          const Vec3d p = source_.grid().position(corner_index(cell, a)), q = source_.grid().position(corner_index(cell, b));
          points.push_back(vec::add(p, vec::mul(vec::sub(q, p), cut->crossing[e])));
        }
      }
    }
  }
  for (std::size_t i = 0; i < present.size(); ++i) {
    block.joined[i] = static_cast<std::int16_t>(present[i] != 0 ? sets.find(static_cast<std::int32_t>(i)) : -1);
  }
  if (points.empty()) return block;
  block.plane = true;
  for (const Vec3d& p : points) block.middle = vec::add(block.middle, vec::mul(p, 1.0 / static_cast<double>(points.size())));
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Vec3d& p : points) {
    const Vec3d d = vec::sub(p, block.middle);
    const Eigen::Vector3d v(d[0], d[1], d[2]);
    moment += v * v.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);  // ascending: the least extent is across the cut
  for (int a = 0; a < 3; ++a) block.normal[a] = solver.eigenvectors()(a, 0);
  std::array<int, kSide * kSide * kSide> count{};
  for (int k = -kReach; k <= kReach; ++k) {
    for (int j = -kReach; j <= kReach; ++j) {
      for (int i = -kReach; i <= kReach; ++i) {
        const GridIndex corner = sum(centre, {i, j, k});
        const int set = block.joined[block.at(corner)];
        if (set < 0) continue;
        block.side[set] += block.distance(source_.grid().position(corner));
        ++count[set];
      }
    }
  }
  return block;
}

// The corner of the lattice that a corner in air goes with: the nearest one on its side of the cut.
GridIndex ExteriorCells::anchor(const GridIndex& corner) {
  for (int c = 0; c < 8; ++c) {
    if (lattice_cell(sum(corner, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)})) >= 0) return corner;
  }
  const Block& around = block(corner);
  const double mine = around.plane ? around.distance(source_.grid().position(corner)) : 0;
  GridIndex best = corner;
  int least = 100;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const GridIndex other = sum(corner, {i, j, k});
        const int set = around.joined[around.at(other)];
        if (set < 0) continue;
        const int far = i * i + j * j + k * k + (around.plane && around.side[set] * mine < 0 ? 10 : 0);
        if (far < least) {
          least = far;
          best = other;
        }
      }
    }
  }
  return best;
}

// Where an edge is cut, from its lower corner, and since when; -1 if it is not. One that no cell of the lattice has counts as
// cut before all others.
ExteriorCells::Crossing ExteriorCells::crossing(const GridIndex& a, const GridIndex& b) {
  bool known = false;
  for (int c = 0; c < 8; ++c) {  // a cell that has both ends
    const GridIndex cell = sum(a, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    const GridIndex d{b[0] - cell[0], b[1] - cell[1], b[2] - cell[2]};
    if (std::max({d[0], d[1], d[2]}) > 1 || lattice_cell(cell) < 0) continue;
    known = true;
    const CutGridCell* cut = cut_cell(cell);
    const int e = kuhn_edge(c, d[0] + 2 * d[1] + 4 * d[2]);
    if (cut != nullptr) return {cut->crossing[e], cut->when[e]};
  }
  if (known) return {};
  const GridIndex p = anchor(a), q = anchor(b);
  const Block& around = block(a);
  const int s = around.joined[around.at(p)], t = around.joined[around.at(q)];
  if (s < 0 || t < 0 || s == t) return {};
  const double u = around.distance(source_.grid().position(a)), w = around.distance(source_.grid().position(b));
  return {u * w < 0 ? std::clamp(u / (u - w), kLeast, 1 - kLeast) : 0.5};
}

// The component of the lattice next to a cell of air that holds a corner: of the cell that is nearest.
Carrier ExteriorCells::carrier(const GridIndex& cell, const GridIndex& corner) {
  Carrier best;
  int least = 100;
  for (int c = 0; c < 8; ++c) {
    const GridIndex other = sum(corner, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    const std::int32_t number = lattice_cell(other);
    if (number < 0) continue;
    int far = 0;
    for (int a = 0; a < 3; ++a) far += (other[a] - cell[a]) * (other[a] - cell[a]);
    if (far >= least) continue;
    least = far;
    const CutGridCell* cut = cut_cell(other);
    best = cut == nullptr ? Carrier{number, 0} : cut->carrier[cut->label[c]];
  }
  return best;
}

CutGridCell ExteriorCells::cut(const GridIndex& index) {
  CutGridCell cell;
  cell.index = index;
  cell.air = true;
  DisjointSets sets(8);
  for (std::size_t e = 0; e < kKuhnEdges.size(); ++e) {
    const auto [a, b] = kKuhnEdges[e];
    const Crossing found = crossing(corner_index(index, a), corner_index(index, b));
    cell.crossing[e] = found.at;
    cell.when[e] = found.when;
    if (cell.crossing[e] < 0) sets.join(a, b);
  }
  int components = 0;
  for (int c = 0; c < 8; ++c) {
    const int lowest = sets.find(c);
    cell.label[c] = static_cast<std::int8_t>(lowest == c ? components++ : cell.label[lowest]);
    Carrier& chosen = cell.carrier[cell.label[c]];
    if (chosen.cell < 0) chosen = carrier(index, corner_index(index, c));
  }
  for (int c = 0; c < 8; ++c) {
    Carrier& chosen = cell.carrier[cell.label[c]];
    if (chosen.cell < 0) chosen = carrier(index, anchor(corner_index(index, c)));
  }
  for (int k = 0; k < components; ++k) {
    if (cell.carrier[k].cell < 0) components = 1;  // too far from the lattice to be divided
  }
  if (components == 1) cell = {index, true, {}, {}, {}, {}, {}};
  return cell;
}

std::vector<CutGridCell> ExteriorCells::update(const std::vector<CutGridCell>& changed) {
  blocks_.clear();
  std::set<GridIndex> around;
  for (const CutGridCell& cell : changed) {
    const std::int64_t number = source_.grid().number(cell.index);
    if (std::all_of(cell.label.begin(), cell.label.end(), [](int label) { return label == 0; })) {
      cut_.erase(number);
    } else {
      cut_[number] = cell;
    }
  }
  for (const CutGridCell& cell : changed) {
    for (int k = -kReach; k <= kReach; ++k) {
      for (int j = -kReach; j <= kReach; ++j) {
        for (int i = -kReach; i <= kReach; ++i) {
          const GridIndex other = sum(cell.index, {i, j, k});
          // The grid has one more cell on every side: a skin on the outer faces of the lattice may count as lying in those.
          bool inside = true;
          for (int a = 0; a < 3; ++a) inside = inside && other[a] >= -1 && other[a] <= source_.grid().size[a];
          if (inside && lattice_cell(other) < 0 && !source_.triangles_at(other).empty()) around.insert(other);
        }
      }
    }
  }
  std::vector<CutGridCell> out;
  for (const GridIndex& cell : around) out.push_back(cut(cell));
  return out;
}

}  // namespace pliant::overlay
