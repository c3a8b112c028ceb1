// What a material answers to a deformation, in double, in terms of H = F - I so that no digit is lost at small strain.
// Energies, statics, tearing and pictures all ask here; kernels and twins have the laws of their own.
#pragma once
#include <Eigen/Dense>
#include <optional>

#include "material/kinematics.h"
#include "material/material.h"

namespace pliant {

/// Energy per rest volume [J/m^3], first Piola-Kirchhoff stress P = dW/dF [Pa] and the tangent dP_ij/dF_kl [Pa] at row 3 i + j,
/// column 3 k + l.
struct Response {
  double energy = 0;
  Eigen::Matrix3d stress;
  Matrix9d tangent;
};

/// Returns false, with nothing written, where the law has no stress: det(I + h) is not finite, or not positive though the law
/// needs that. `tangent`: whether it is wanted.
bool respond(const Material& material, const Eigen::Matrix3d& h, bool tangent, Response& out);

/// Linear elasticity with the same moduli: every law agrees with it at h = 0.
void respond_linear(const Material& material, const Eigen::Matrix3d& h, Response& out);

/// Energy per rest volume without the volumetric part U(J) = k/2 (J - 1)^2, and k (0: the law has no such part). NaN or
/// infinite where the law has no energy.
double energy_without_volume(const Material& material, const Eigen::Matrix3d& h);
double volume_modulus(const Material& material);

/// Cauchy stress P F^T / J [Pa]; nothing where J is not a positive, finite number.
std::optional<Eigen::Matrix3d> cauchy_stress(const Material& material, const Eigen::Matrix3d& h);

}  // namespace pliant
