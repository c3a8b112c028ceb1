// Compressible neo-Hookean law (Bonet and Wood 2008, with (J - 1)^2 for their (ln J)^2).
//   W = mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2,   P = mu (F - F^-T) + lambda (J - 1) cof F
#pragma once
#include "material/law.h"

namespace pliant::laws {

struct NeoHookean {
  static constexpr ParameterInfo parameters[]{
      {"mu", "Pa", least_modulus, most_modulus, "shear modulus"},
      {"lambda", "Pa", -most_modulus, most_modulus, "first Lame constant"},
  };
  static constexpr LawInfo info{.word = "neo-hookean",
                                .energy = "mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2",
                                .source = "Bonet and Wood 2008",
                                .parameters = parameters,
                                .takes_moduli = true,
                                .volumetric = true,
                                .invertible = false,
                                .flops = 67};
  double mu, lambda;

  explicit NeoHookean(const double* p) : mu(p[0]), lambda(p[1]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {m.mu, m.lambda}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_lame(lambda, mu); }
  [[nodiscard]] std::vector<double> constants() const { return {mu, lambda}; }

  [[nodiscard]] double bulk() const { return lambda; }
  [[nodiscard]] double energy(const Kinematics& k) const {
    return mu / 2 * k.stretch() - mu * (k.is_low() ? k.continued_log().value : std::log1p(k.j));
  }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const {
    if (k.is_low()) return mu * (k.f - k.continued_log().slope * k.cofactor);
    return mu / (1 + k.j) * k.difference;
  }
  void add_tangent(const Kinematics& k, Matrix9d& out) const {
    out += mu * Matrix9d::Identity();
    if (k.is_low()) {
      add_function_of_j(out, -mu, k.continued_log(), 1, Eigen::Matrix3d::Zero(), k);
      return;
    }
    add_crossed(out, mu, k.inverse_transposed());
  }
};

}  // namespace pliant::laws
