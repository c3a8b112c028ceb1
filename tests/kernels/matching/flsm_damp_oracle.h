// Increments of nodes and the rigid motions of regions nearest to them, by least squares.
#pragma once
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {

/// w = v + omega x R o at the offset o from a region's centre: v [m] and omega [m per cell].
struct RigidRate {
  Vector3d v = Vector3d::Zero(), omega = Vector3d::Zero();
  bool turns = true;  ///< whether the nodes determine omega; if not, v is their mean and omega is zero
};

inline Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// Mass and offset of the nodes of a region.
inline void for_region(const FlsmLattice& lattice, int i, const std::function<void(int, double, const Vector3d&)>& visit) {
  lattice.for_window(true, true, true, [&](const Offset& o) {
    if (lattice.holds(i, o)) visit(lattice.at(i, o), lattice.mass(lattice.at(i, o)), Vector3d(o[0], o[1], o[2]));
  });
}

/// The inertia of a region about its centroid.
inline Matrix3d inertia_of(const FlsmLattice& lattice, int i) {
  double mass = 0;
  Vector3d centroid = Vector3d::Zero();
  for_region(lattice, i, [&](int, double m, const Vector3d& o) {
    mass += m;
    centroid += m * o;
  });
  centroid /= mass;
  Matrix3d inertia = Matrix3d::Zero();
  for_region(lattice, i, [&](int, double m, const Vector3d& o) {
    const Matrix3d cross = cross_matrix(o - centroid);
    inertia -= m * cross * cross;
  });
  return inertia;
}

/// One row of three equations per node, sqrt(m) (v - [R o] omega) = sqrt(m) w, and their solution.
inline RigidRate nearest_rate(const FlsmLattice& lattice, int i, const Matrix3d& r) {
  std::vector<std::pair<double, Vector3d>> nodes;
  std::vector<Vector3d> w;
  for_region(lattice, i, [&](int node, double m, const Vector3d& o) {
    nodes.emplace_back(m, r * o);
    w.push_back(lattice.u(node));
  });
  Eigen::MatrixXd a(3 * nodes.size(), 6);
  Eigen::VectorXd b(3 * nodes.size());
  Vector3d sum = Vector3d::Zero();
  double mass = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * k);
    const auto& [m, x] = nodes[k];
    a.block<3, 3>(row, 0) = std::sqrt(m) * Matrix3d::Identity();
    a.block<3, 3>(row, 3) = -std::sqrt(m) * cross_matrix(x);
    b.segment<3>(row) = std::sqrt(m) * w[k];
    mass += m;
    sum += m * w[k];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  qr.setThreshold(1e-9);
  if (qr.rank() < 6) return {sum / mass, Vector3d::Zero(), false};
  const Eigen::VectorXd x = qr.solve(b);
  return {x.head<3>(), x.tail<3>()};
}

inline Matrix3d random_turn(Random& random) {
  return nearest_rotation(Matrix3d::NullaryExpr([&] { return random.uniform(-1, 1); }));
}

/// What flsm_damp_region reads, for the increments lattice.u() and the rotations of the regions. Where the nodes of a region
/// lie on a line it has no inertia to divide by, and its spin is zero.
inline FlsmData damp_region_data(const FlsmLattice& lattice, const std::vector<Matrix3d>& rotation) {
  FlsmData d = lattice.data();
  d.node_w = d.node_u;
  d.plates = lattice.moments(true, PLIANT_FLSM_RECORD);
  d.rates.assign(PLIANT_FLSM_RECORD * d.count, 77);
  d.spin.assign(PLIANT_FLSM_SPIN_PLANES * d.count, 0);
  for (std::size_t k = 3; k < d.node_w.size(); k += 4) d.node_w[k] = 0.97;  // the decay
  for (int i = 0; i < lattice.nodes(); ++i) {
    const auto region = static_cast<std::size_t>(i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Matrix3d hd = FlsmLattice::spacing * (rotation[region] - Matrix3d::Identity());
      put(d.regions, PLIANT_FLSM_RECORD * region + 4 * axis + 4, hd.col(static_cast<Eigen::Index>(axis)));
    }
    const Matrix3d inertia = inertia_of(lattice, i);
    if (Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvalues()[0] < 1e-6 * inertia.trace()) continue;
    const Matrix3d inverse = FlsmLattice::spacing * inertia.inverse();
    const double plane[PLIANT_FLSM_SPIN_PLANES] = {inverse(0, 0), inverse(1, 1), inverse(2, 2),
                                                   inverse(0, 1), inverse(0, 2), inverse(1, 2)};
    const std::size_t base = region / PLIANT_TILE * PLIANT_FLSM_SPIN_PLANES * PLIANT_TILE + region % PLIANT_TILE;
    for (std::size_t p = 0; p < PLIANT_FLSM_SPIN_PLANES; ++p) d.spin[base + p * PLIANT_TILE] = plane[p];
  }
  return d;
}

/// A rigid motion of the whole lattice turned by `turn`: w = v + omega x turn X, omega in m per m.
struct RigidField {
  Matrix3d turn = Matrix3d::Identity();
  Vector3d v = Vector3d::Zero(), omega = Vector3d::Zero();
  Vector3d operator()(const Vector3d& rest) const { return v + omega.cross(turn * rest); }
};

inline RigidField random_field(Random& random) {
  RigidField field{random_turn(random)};
  field.v = 1e-3 * Vector3d::NullaryExpr([&] { return random.uniform(-1, 1); });
  field.omega = 1e-2 * Vector3d::NullaryExpr([&] { return random.uniform(-1, 1); });
  return field;
}

}  // namespace pliant::kernel_test
