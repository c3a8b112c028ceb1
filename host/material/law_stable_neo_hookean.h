// Stable neo-Hookean law (Smith, de Goes and Kim 2018): finite for every F, and the rest state is stable.
//   W = mu'/2 (I1 - 3) + lambda'/2 (J - alpha)^2 - mu'/2 ln(I1 + 1),  alpha = 1 + mu' / lambda' - mu' / (4 lambda')
// mu' = 4/3 mu and lambda' = lambda + 5/6 mu make mu and lambda those of linear elasticity. Here the constant that makes W zero
// at rest is added, and (J - alpha)^2 is split into (J - 1)^2, the volumetric part, and a linear term: lambda' (1 - alpha) =
// -3/4 mu'.
#pragma once
#include "material/law.h"

namespace pliant::laws {

struct StableNeoHookean {
  static constexpr ParameterInfo parameters[]{
      {"mu", "Pa", least_modulus, most_modulus, "shear modulus"},
      {"lambda", "Pa", -most_modulus, most_modulus, "first Lame constant"},
  };
  static constexpr LawInfo info{
      .word = "stable-neo-hookean",
      .energy = "m/2 (I1 - 3) - m/2 ln((I1 + 1)/4) - 3 m/4 (J - 1) + l/2 (J - 1)^2, m = 4/3 mu, l = lambda + 5/6 mu",
      .source = "Smith, de Goes and Kim 2018",
      .parameters = parameters,
      .takes_moduli = true,
      .volumetric = true,
      .invertible = true,
      .flops = 88};
  double mu, lambda;

  explicit StableNeoHookean(const double* p) : mu(p[0]), lambda(p[1]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {m.mu, m.lambda}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_lame(lambda, mu); }
  [[nodiscard]] std::vector<double> constants() const { return {mu, bulk()}; }

  [[nodiscard]] double bulk() const { return lambda + 5 * mu / 6; }
  [[nodiscard]] double energy(const Kinematics& k) const {
    const double e = k.stretch();
    return 4 * mu / 3 * (e / 2 - std::log1p(e / 4) / 2 - 0.75 * k.j);
  }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const {
    const double e = k.stretch();
    // F - cof F, whose large terms cancel.
    const Eigen::Matrix3d difference =
        k.h + k.h.transpose() - k.trace * Eigen::Matrix3d::Identity() - Kinematics::cofactor_of(k.h);
    return mu * difference + mu * e / (3 * (4 + e)) * k.f;
  }
  void add_tangent(const Kinematics& k, Matrix9d& out) const {
    const double sum = 4 + k.stretch();  // I1 + 1
    out += 4 * mu / 3 * (1 - 1 / sum) * Matrix9d::Identity();
    add_product(out, 8 * mu / 3 / (sum * sum), k.f, k.f);
    add_cofactor_slope(out, -mu, k.f);
  }
};

}  // namespace pliant::laws
