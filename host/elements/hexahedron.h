// The trilinear hexahedron at its 2 x 2 x 2 Gauss points, corners in bit order.
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <string>

#include "geometry/vec3.h"
#include "material/material.h"

namespace pliant {

using Corners8 = Eigen::Matrix<double, 8, 3>;        ///< a row for each corner, in bit order
using Displacements8 = Eigen::Matrix<double, 3, 8>;  ///< a column for each corner [m]

struct GaussPoint {
  Corners8 gradients;  ///< [1/m]
  double weight;       ///< [m^3]
};

Corners8 corners8(std::span<const Vec3d> x);
/// Of a cube with one corner at 0 [m].
Corners8 cube_corners(double edge);
/// Throws Error (`what` names the element) when the Jacobian is not positive at one of them.
std::array<GaussPoint, 8> gauss_points(const Corners8& x, const std::string& what);

/// lambda tr A + 2 mu lambda_max(A) with A = sum_a grad N_a grad N_a^T [Pa/m^2].
double modulus_bound(const Eigen::Matrix<double, Eigen::Dynamic, 3>& gradients, const Material& m);

}  // namespace pliant
