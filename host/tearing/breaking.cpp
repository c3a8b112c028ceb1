#include "tearing/breaking.h"

#include "material/response.h"

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
  const Matrix3d before = edges_of(rest);
  return cauchy_stress(m, (edges_of(now) - before) * before.inverse());
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
