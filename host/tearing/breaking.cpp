#include "tearing/breaking.h"

#include <cmath>

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d edges_of(const std::array<Vec3d, 4>& x) {
  Matrix3d m;
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) m(c, a) = x[a + 1][c] - x[0][c];
  }
  return m;
}

}  // namespace

std::optional<Matrix3d> tet_stress(const std::array<Vec3d, 4>& rest, const std::array<Vec3d, 4>& now, const Material& m) {
  const Matrix3d f = edges_of(now) * edges_of(rest).inverse();
  const double j = f.determinant();
  if (!(j > 0) || !f.allFinite()) return {};
  const Matrix3d identity = Matrix3d::Identity(), left = f * f.transpose();
  switch (m.law) {
    case Law::neo_hookean:
      return m.mu / j * (left - identity) + m.lambda * (j - 1) * identity;
    case Law::isochoric_neo_hookean:
      return m.mu * std::pow(j, -5.0 / 3) * (left - left.trace() / 3 * identity) + m.kappa * (j - 1) * identity;
    case Law::saint_venant_kirchhoff:
      break;
  }
  const Matrix3d strain = 0.5 * (f.transpose() * f - identity);
  return f * (m.lambda * strain.trace() * identity + 2 * m.mu * strain) * f.transpose() / j;
}

CuttingTraction cutting_traction(const Matrix3d& stress, const Vector3d& normal, const BreakingLaw& law) {
  const Vector3d traction = stress * normal / law.sharpness;
  CuttingTraction t;
  t.normal = traction.dot(normal);
  t.shear = (traction - t.normal * normal).norm();
  return t;
}

double cutting_stress(const Matrix3d& stress, const BreakingLaw& law) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(0.5 * (stress + stress.transpose()) / law.sharpness, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2] / law.integrity;
}

}  // namespace pliant
