// The three laws with their consistent tangents, in double, in terms of H = F - I so that no digit is lost at small strain.
#pragma once
#include <Eigen/Dense>

#include "scene/scene.h"

namespace pliant::statics {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Energy per rest volume [J/m^3], first Piola-Kirchhoff stress P = dW/dF [Pa] and the tangent dP_ij/dF_kl [Pa] at row 3 i + j,
/// column 3 k + l. Energies are those of solver/energy.h.
struct Response {
  double energy = 0;
  Eigen::Matrix3d stress;
  Matrix9d tangent;
};

/// Returns false, with nothing written, when det(I + h) is not a positive, finite number. `tangent`: whether it is wanted.
bool respond(const Material& material, const Eigen::Matrix3d& h, bool tangent, Response& out);

/// Linear elasticity with the same constants: all three laws agree with it at h = 0.
void respond_linear(const Material& material, const Eigen::Matrix3d& h, Response& out);

}  // namespace pliant::statics
