// Stress response of materials in double, in terms of H = F - I to avoid cancellation at small strain. Used by energies,
// statics, tearing and pictures; kernels and twins have their own implementations.
#pragma once
#include <Eigen/Dense>
#include <optional>

#include "material/kinematics.h"
#include "material/material.h"

namespace pliant {

/// Energy per undeformed volume [J/m^3], first Piola-Kirchhoff stress P = dW/dF [Pa] and the tangent dP_ij/dF_kl [Pa] at row
/// 3 i + j, column 3 k + l.
struct Response {
  double energy = 0;
  Eigen::Matrix3d stress;
  Matrix9d tangent;
};

/// Returns false and writes nothing if the law has no stress: det(I + h) is not finite, or not positive although the law
/// requires it. `tangent`: whether to compute the tangent.
bool respond(const Material& material, const Eigen::Matrix3d& h, bool tangent, Response& out);

/// Linear elasticity with the same moduli, with which every law agrees at h = 0.
void respond_linear(const Material& material, const Eigen::Matrix3d& h, Response& out);

/// Energy per undeformed volume without the volumetric part U(J) = k/2 (J - 1)^2; and its k (0 without such a part). NaN or
/// infinite where the energy is undefined.
double energy_without_volume(const Material& material, const Eigen::Matrix3d& h);
double volume_modulus(const Material& material);

/// Green-Lagrange strain (F^T F - I) / 2.
Eigen::Matrix3d green_strain(const Eigen::Matrix3d& h);
/// Almansi strain (I - F^-T F^-1) / 2; empty if J is not a positive, finite number.
std::optional<Eigen::Matrix3d> almansi_strain(const Eigen::Matrix3d& h);

/// Cauchy stress P F^T / J [Pa]; empty if J is not a positive, finite number.
std::optional<Eigen::Matrix3d> cauchy_stress(const Material& material, const Eigen::Matrix3d& h);

}  // namespace pliant
