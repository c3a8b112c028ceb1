// Saint-Venant-Kirchhoff law: linear elasticity of the Green-Lagrange strain E = (F^T F - I) / 2.
//   W = lambda/2 (tr E)^2 + mu E:E,   P = F (lambda tr(E) I + 2 mu E)
// It is finite for every F, but loses its resistance as J approaches 0: below `low` it has the additional term 16/3 (lambda +
// 2 mu) (low - J)^3.
#pragma once
#include "material/law.h"

namespace pliant::laws {

struct SaintVenantKirchhoff {
  static constexpr ParameterInfo parameters[]{
      {"mu", "Pa", least_modulus, most_modulus, "shear modulus"},
      {"lambda", "Pa", -most_modulus, most_modulus, "first Lame constant"},
  };
  static constexpr LawInfo info{.word = "saint-venant-kirchhoff",
                                .energy = "lambda/2 (tr E)^2 + mu E:E, E = (F^T F - I)/2",
                                .source = "Bonet and Wood 2008",
                                .parameters = parameters,
                                .takes_moduli = true,
                                .volumetric = false,
                                .invertible = false,
                                .flops = 116};
  double mu, lambda;

  explicit SaintVenantKirchhoff(const double* p) : mu(p[0]), lambda(p[1]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {m.mu, m.lambda}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_lame(lambda, mu); }
  [[nodiscard]] std::vector<double> constants() const { return {mu, lambda}; }

  [[nodiscard]] double bulk() const { return 0; }
  [[nodiscard]] double energy(const Kinematics& k) const {
    const Eigen::Matrix3d e = strain(k);
    return lambda / 2 * e.trace() * e.trace() + mu * e.squaredNorm() + barrier(k).value;
  }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const { return k.f * second(k) + barrier(k).slope * k.cofactor; }
  void add_tangent(const Kinematics& k, Matrix9d& out) const {
    const Eigen::Matrix3d left = k.f * k.f.transpose(), s = second(k);
    add_product(out, lambda, k.f, k.f);
    add_crossed(out, mu, k.f);
    if (k.is_low()) add_function_of_j(out, 1, barrier(k), 1, Eigen::Matrix3d::Zero(), k);
    for (int r = 0; r < 9; ++r) {
      for (int c = 0; c < 9; ++c) {
        if (r / 3 == c / 3) out(r, c) += s(r % 3, c % 3);
        if (r % 3 == c % 3) out(r, c) += mu * left(r / 3, c / 3);
      }
    }
  }

 private:
  static Eigen::Matrix3d strain(const Kinematics& k) { return 0.5 * (k.h + k.h.transpose() + k.h.transpose() * k.h); }
  [[nodiscard]] OfJ barrier(const Kinematics& k) const {
    if (!k.is_low()) return {};
    const double below = k.low - (1 + k.j), c = 16 * (lambda + 2 * mu);
    return {c / 3 * below * below * below, -c * below * below, 2 * c * below};
  }
  [[nodiscard]] Eigen::Matrix3d second(const Kinematics& k) const {
    const Eigen::Matrix3d e = strain(k);
    return lambda * e.trace() * Eigen::Matrix3d::Identity() + 2 * mu * e;
  }
};

}  // namespace pliant::laws
