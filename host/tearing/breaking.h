// The physical breaking criterion of Mendoza et al. (docs/references.md): what stress an edge of sharpness kappa makes, and
// when the material gives way to it.
//
//   cutting traction on a surface with normal n:   t = (sigma n + tau s) / kappa, normal stress sigma, shear stress tau along s
//   T = stress / kappa, principal stresses sigma_1, sigma_2, sigma_3;  cutting stress sigma_c = sigma_max / zeta;  it breaks if
//   sigma_c >= K_I
#pragma once
#include <Eigen/Dense>
#include <array>
#include <optional>

#include "scene/scene.h"

namespace pliant {

struct BreakingLaw {
  double sharpness = 1;  ///< kappa, the smaller the sharper; 1: no blade
  double integrity = 1;  ///< zeta in (0, 1], what earlier loads have left ("damage" in Mendoza et al.); 1: intact
  double toughness = 0;  ///< K_I [Pa]
};

/// Cauchy stress [Pa] of a tetrahedron with corners `rest` and `now` [m]; nothing if it is inverted or not finite.
std::optional<Eigen::Matrix3d> tet_stress(const std::array<Vec3d, 4>& rest, const std::array<Vec3d, 4>& now,
                                          const Material& material);

/// Normal part (tension positive) and amount of the shear part of the cutting traction [Pa].
struct CuttingTraction {
  double normal = 0, shear = 0;
};
CuttingTraction cutting_traction(const Eigen::Matrix3d& stress, const Eigen::Vector3d& normal, const BreakingLaw& law);

/// sigma_c [Pa]: the largest principal stress over sharpness and integrity.
double cutting_stress(const Eigen::Matrix3d& stress, const BreakingLaw& law);

inline bool breaks(const Eigen::Matrix3d& stress, const BreakingLaw& law) {
  return cutting_stress(stress, law) >= law.toughness;
}

}  // namespace pliant
