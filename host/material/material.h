// Materials as plain data: the law, its parameters, and the moduli of linear elasticity that it has at small strain. What a law
// is stands in law_STEM.h, a file per law of kernels/laws.h; what it answers to a deformation is asked through response.h.
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "laws.h"

namespace pliant {

/// Kernels work in float: positive numbers of a material reach from the least to the most.
inline constexpr double least_modulus = 1e-30, most_modulus = 1e30;

/// Below this J what is singular at J = 0 gives way to polynomials, so that elements survive their inversion.
inline constexpr double low_volume = 0.25;

/// Isotropic linear elasticity; kappa = lambda + 2 mu / 3.
struct Moduli {
  double mu = 0;      ///< shear modulus [Pa]
  double lambda = 0;  ///< first Lame constant [Pa]
  double kappa = 0;   ///< bulk modulus [Pa]
  static Moduli from_young(double young, double poisson);
  static Moduli from_lame(double lambda, double mu);
  static Moduli from_bulk(double mu, double kappa);
  [[nodiscard]] double young() const { return 9 * kappa * mu / (3 * kappa + mu); }
  [[nodiscard]] double poisson() const { return (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu)); }
};

/// One parameter of a law: its key in a scene file.
struct ParameterInfo {
  const char* name;
  const char* unit;
  double lower, upper;  ///< inclusive; lower == least_modulus means: greater than zero
  const char* what;
};

/// What all users of a law need to know. Energies are per rest volume, with I1 = |F|^2 and J = det F.
struct LawInfo {
  const char* word;    ///< its name in a scene file
  const char* energy;  ///< W(F), for people
  const char* source;  ///< who described it
  std::span<const ParameterInfo> parameters;
  bool takes_moduli;  ///< two elastic constants determine it: a scene file gives those (young + poisson, ...), not its
                      ///< parameters
  bool volumetric;    ///< W = (...) + U(J) with U = k/2 (J - 1)^2, whose derivative tet4anp averages
  bool invertible;    ///< finite for J <= 0 as it is; others need Material::low
  double flops;       ///< of law_stress in its kernel fragment (an fma is two)
};

const LawInfo& law_info(Law law);
/// In the order of kernels/laws.h.
std::span<const Law, law_count> all_laws();
inline const char* to_string(Law law) { return law_info(law).word; }

/// Young's modulus of each element.
struct YoungField {
  std::string name;            ///< of the array in the file of the mesh
  double poisson = 0;          ///< the same everywhere
  std::vector<double> values;  ///< [elements] of the uncut mesh [Pa]
  double largest = 0;          ///< of the values that are moduli [Pa]
};

/// A hyperelastic material. The law, its parameters and the moduli are set together.
struct Material {
  Law law = Law::neo_hookean;
  std::vector<double> parameters;                 ///< of the law, in the order of LawInfo::parameters
  Moduli moduli;                                  ///< at small strain: the stable step, hourglass control, hints of stiffness
  std::shared_ptr<const YoungField> young_field;  ///< null: one modulus; else parameters and moduli are those of its largest
  double density = 1000;                          ///< [kg/m^3]
  double viscosity = 0;       ///< of shear, eta [Pa s]: Kelvin and Voigt's stress 2 eta dev(D) + zeta tr(D) I
  double bulk_viscosity = 0;  ///< zeta [Pa s]; with a field both are those of the largest modulus
  double damping = 0;         ///< mass-proportional damping rate c [1/s]: M u'' + c M u' = R - F
  double hourglass = 1;       ///< factor on the hourglass stiffness of hex8 (1: exact bending of a bar at nu = 0)
  double toughness = 0;       ///< K_I: principal stress at which it tears [Pa]; 0: it does not
  double integrity = 1;       ///< zeta in (0, 1]: the share of the toughness that is left
  double low = 0;             ///< low_volume: below this J the law is continued (kinematics.h); 0: it ends at J = 0

  [[nodiscard]] bool viscous() const { return viscosity > 0 || bulk_viscosity > 0; }
  /// Largest ratio of viscosity to modulus [s]: at small strain the viscous forces of a motion are at most so much times those
  /// of the elements for it.
  [[nodiscard]] double viscous_time() const { return std::max(viscosity / moduli.mu, bulk_viscosity / moduli.kappa); }

  /// The law with these moduli at small strain. Where they do not determine it, it is a typical one with them.
  void set_moduli(Law law, const Moduli& moduli);
  void set_parameters(Law law, std::vector<double> parameters);
  /// So many times as stiff at every strain: all stresses of all laws are linear in their moduli.
  [[nodiscard]] Material scaled(double factor) const;
};

Material make_material(Law law, const Moduli& moduli, double density = 1000);

/// What the kernels get as `law_parameters`: `low`, then the parameters, or what the law makes of them.
std::vector<double> law_constants(const Material& material);

}  // namespace pliant
