// Materials as plain data: the law, its parameters, and its linear elastic moduli at small strain. The laws are in
// law_STEM.h, a file per law of kernels/laws.h; response.h evaluates them.
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "laws.h"

namespace pliant {

/// Range of positive material numbers that the float kernels can handle.
inline constexpr double least_modulus = 1e-30, most_modulus = 1e30;

/// Below this J, expressions that are singular at J = 0 are replaced by polynomials, so that elements can recover from
/// inversion.
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
  friend bool operator==(const Moduli&, const Moduli&) = default;
};

/// A parameter of a law, with its key in a scene file.
struct ParameterInfo {
  const char* name;
  const char* unit;
  double lower, upper;  ///< inclusive; lower == least_modulus means: greater than zero
  const char* what;
};

/// Properties of a law. Energies are per undeformed volume, with I1 = |F|^2 and J = det F.
struct LawInfo {
  const char* word;    ///< name in a scene file
  const char* energy;  ///< W(F), for display
  const char* source;  ///< literature reference
  std::span<const ParameterInfo> parameters;
  bool takes_moduli;  ///< two elastic constants determine it, so a scene file gives those (young + poisson, ...) instead of its
                      ///< parameters
  bool volumetric;    ///< W = (...) + U(J) with U = k/2 (J - 1)^2, whose derivative elements can average over nodes
  bool invertible;    ///< finite for J <= 0; others need Material::low
  double flops;       ///< operations of law_stress in its kernel fragment (an fma is two)
};

const LawInfo& law_info(Law law);
/// In the order of kernels/laws.h.
std::span<const Law, law_count> all_laws();
inline const char* to_string(Law law) { return law_info(law).word; }

/// Young's modulus per element.
struct YoungField {
  std::string name;            ///< name of the array in the mesh file
  double poisson = 0;          ///< uniform Poisson's ratio
  std::vector<double> values;  ///< [elements] of the uncut mesh [Pa]
  double largest = 0;          ///< largest valid modulus [Pa]
};

/// A hyperelastic material. Law, parameters and moduli must be set together.
struct Material {
  Law law = Law::neo_hookean;
  std::vector<double> parameters;  ///< in the order of LawInfo::parameters
  Moduli moduli;                   ///< at small strain, for the stable step, hourglass control and warnings
  std::shared_ptr<const YoungField>
      young_field;               ///< null: uniform; otherwise parameters and moduli belong to its largest value
  double density = 1000;         ///< [kg/m^3]
  double viscosity = 0;          ///< shear viscosity eta [Pa s] of the Kelvin-Voigt stress 2 eta dev(D) + zeta tr(D) I
  double bulk_viscosity = 0;     ///< zeta [Pa s]; with a field, both belong to the largest modulus
  double stiffness_damping = 0;  ///< b of the damping b K (Rayleigh): eta and zeta have b mu and b kappa more [s]
  double damping = 0;            ///< mass-proportional damping rate c [1/s]: M u'' + c M u' = R - F
  double hourglass = 1;          ///< factor on the stiffness of hourglass control (1: exact bending of a bar at nu = 0)
  double toughness = 0;          ///< K_I: principal stress at which it tears [Pa]; 0: never
  double integrity = 1;          ///< zeta in (0, 1]: remaining fraction of the toughness
  double low = 0;                ///< low_volume: the law is continued below this J (kinematics.h); 0: undefined for J <= 0

  [[nodiscard]] double eta() const { return viscosity + stiffness_damping * moduli.mu; }
  [[nodiscard]] double zeta() const { return bulk_viscosity + stiffness_damping * moduli.kappa; }
  [[nodiscard]] bool viscous() const { return eta() > 0 || zeta() > 0; }
  /// Largest ratio of viscosity to modulus [s]: at small strain, viscous forces are at most this times the elastic forces of
  /// the corresponding velocity.
  [[nodiscard]] double viscous_time() const { return std::max(eta() / moduli.mu, zeta() / moduli.kappa); }

  /// Returns the law with these moduli at small strain. If they do not determine it, it is a typical one with these moduli.
  void set_moduli(Law law, const Moduli& moduli);
  void set_parameters(Law law, std::vector<double> parameters);
  /// Scales the stiffness at every strain: the stresses of all laws are linear in their moduli.
  [[nodiscard]] Material scaled(double factor) const;
  friend bool operator==(const Material&, const Material&) = default;
};

Material make_material(Law law, const Moduli& moduli, double density = 1000);

/// Returns the `law_parameters` for the kernels: `low`, then the parameters or values derived from them.
std::vector<double> law_constants(const Material& material);

}  // namespace pliant
