// Neo-Hookean law with an isochoric and a volumetric part (Simo, Taylor and Pister 1985): W = mu/2 (J^-2/3 I1 - 3) + U(J).
#pragma once
#include "material/isochoric.h"
#include "material/law.h"

namespace pliant::laws {

struct IsochoricNeoHookean {
  static constexpr ParameterInfo parameters[]{
      {"mu", "Pa", least_modulus, most_modulus, "shear modulus"},
      {"kappa", "Pa", least_modulus, most_modulus, "bulk modulus"},
  };
  static constexpr LawInfo info{.word = "isochoric-neo-hookean",
                                .energy = "mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2",
                                .source = "Simo, Taylor and Pister 1985",
                                .parameters = parameters,
                                .takes_moduli = true,
                                .volumetric = true,
                                .invertible = false,
                                .flops = 126};
  double mu, kappa;

  explicit IsochoricNeoHookean(const double* p) : mu(p[0]), kappa(p[1]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {m.mu, m.kappa}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_bulk(mu, kappa); }
  [[nodiscard]] std::vector<double> constants() const { return {mu, kappa}; }

  [[nodiscard]] double bulk() const { return kappa; }
  [[nodiscard]] double energy(const Kinematics& k) const { return mu / 2 * IsochoricFirst(k).excess; }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const { return mu / 2 * IsochoricFirst(k).gradient; }
  void add_tangent(const Kinematics& k, Matrix9d& out) const { IsochoricFirst(k).add_curvature(k, mu / 2, out); }
};

}  // namespace pliant::laws
