// Follower pressure as the nodal loads that are consistent with what its surface is made of, and their derivative.
#pragma once
#include <vector>

#include "statics/shape.h"

namespace pliant::statics {

/// A point of a rule over a triangle, x(r, s) = X(r, s) + sum_a n[a] u_a.
struct PressurePoint {
  Eigen::VectorXd n;          ///< [nodes] at the point
  Eigen::Matrix2Xd gradient;  ///< [nodes] d n / dr and d n / ds
  Vector3d along_r, along_s;  ///< d X / dr and d X / ds [m]
  double weight = 0;          ///< of the unit triangle's area, 1/2
  [[nodiscard]] Vector3d r(const Eigen::Matrix3Xd& u) const { return along_r + u * gradient.row(0).transpose(); }
  [[nodiscard]] Vector3d s(const Eigen::Matrix3Xd& u) const { return along_s + u * gradient.row(1).transpose(); }
};

/// A triangle under pressure p. The force on node a is -p times the integral of n[a] x_r cross x_s over r and s.
struct PressurePatch {
  std::vector<std::int32_t> nodes;  ///< different ones
  std::vector<PressurePoint> points;
  double pressure = 0;  ///< [Pa]

  /// Displacements of its nodes out of all components.
  [[nodiscard]] Eigen::Matrix3Xd of(const Eigen::VectorXd& all) const;
  [[nodiscard]] Eigen::Matrix3Xd forces(const Eigen::Matrix3Xd& u) const;  ///< [N], column a: on node a
  /// The symmetric part of minus their derivative, [3 nodes][3 nodes]. The other part vanishes inside a surface and is left at
  /// the rim of an open one.
  [[nodiscard]] Eigen::MatrixXd stiffness(const Eigen::Matrix3Xd& u) const;
  /// The product of the other part of minus their derivative with a change d.
  [[nodiscard]] Eigen::Matrix3Xd skew_product(const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& d) const;
};

/// Of Problem::pressures and Problem::face_pressures, which have been checked.
std::vector<PressurePatch> pressure_patches(const Problem& problem);

}  // namespace pliant::statics
