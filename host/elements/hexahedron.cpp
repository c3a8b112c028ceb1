#include "elements/hexahedron.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pliant/error.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;

/// dN_a / d(xi, eta, zeta).
Corners8 local_derivatives(double xi, double eta, double zeta) {
  Corners8 d;
  for (int a = 0; a < 8; ++a) {
    const double sx = (a & 1) ? 1 : -1, sy = (a & 2) ? 1 : -1, sz = (a & 4) ? 1 : -1;
    d.row(a) << sx * (1 + sy * eta) * (1 + sz * zeta) / 8, sy * (1 + sx * xi) * (1 + sz * zeta) / 8,
        sz * (1 + sx * xi) * (1 + sy * eta) / 8;
  }
  return d;
}

double largest_of_three(const Matrix3d& a) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace

Corners8 corners8(std::span<const Vec3d> x) {
  Corners8 m;
  for (int a = 0; a < 8; ++a) m.row(a) << x[a][0], x[a][1], x[a][2];
  return m;
}

Corners8 cube_corners(double edge) {
  Corners8 x;
  for (int a = 0; a < 8; ++a) x.row(a) << edge * (a & 1), edge * (a >> 1 & 1), edge * (a >> 2 & 1);
  return x;
}

std::array<GaussPoint, 8> gauss_points(const Corners8& x, const std::string& what) {
  const double g = 1 / std::sqrt(3.0);
  std::array<GaussPoint, 8> points;
  for (int p = 0; p < 8; ++p) {
    const Corners8 local = local_derivatives((p & 1) ? g : -g, (p & 2) ? g : -g, (p & 4) ? g : -g);
    const Matrix3d jacobian = x.transpose() * local;  // dX_i / dxi_j
    const double det = jacobian.determinant();
    if (!(det > 0)) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("{}: the Jacobian of the hexahedron is {:.6g} m^3 at Gauss point {}, it must be positive", what, det, p));
    }
    points[p] = {local * jacobian.inverse(), det};
  }
  return points;
}

double modulus_bound(const Eigen::Matrix<double, Eigen::Dynamic, 3>& gradients, const Material& m) {
  const Matrix3d a = gradients.transpose() * gradients;
  return std::max(m.moduli.lambda, 0.0) * a.trace() + 2 * m.moduli.mu * largest_of_three(a);
}

}  // namespace pliant
