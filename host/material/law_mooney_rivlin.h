// Mooney-Rivlin law (Mooney 1940; Rivlin 1948) of the isochoric invariants (Flory 1961), with a volumetric part:
//   W = c10 (I1* - 3) + c01 (I2* - 3) + U(J),  I1* = J^-2/3 I1,  I2* = J^-4/3 I2,  I2 = ((tr C)^2 - tr C^2) / 2,  C = F^T F
#pragma once
#include "material/isochoric.h"
#include "material/law.h"

namespace pliant::laws {

struct MooneyRivlin {
  static constexpr ParameterInfo parameters[]{
      {"c10", "Pa", -most_modulus, most_modulus, "coefficient of the first invariant; c10 + c01, half the shear modulus, > 0"},
      {"c01", "Pa", -most_modulus, most_modulus, "coefficient of the second invariant"},
      {"kappa", "Pa", least_modulus, most_modulus, "bulk modulus"},
  };
  static constexpr LawInfo info{
      .word = "mooney-rivlin",
      .energy = "c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2, I2 = ((tr C)^2 - tr C^2)/2, C = F^T F",
      .source = "Mooney 1940, Rivlin 1948",
      .parameters = parameters,
      .takes_moduli = false,
      .volumetric = true,
      .invertible = false,
      .flops = 266};
  double c10, c01, kappa;

  explicit MooneyRivlin(const double* p) : c10(p[0]), c01(p[1]), kappa(p[2]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {0.4 * m.mu, 0.1 * m.mu, m.kappa}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_bulk(2 * (c10 + c01), kappa); }
  [[nodiscard]] std::vector<double> constants() const { return {2 * c10, 2 * c01, kappa}; }

  [[nodiscard]] double bulk() const { return kappa; }
  [[nodiscard]] double energy(const Kinematics& k) const {
    if (k.is_low()) {
      return c10 * IsochoricFirst(k).excess + c01 * (k.continued_power(-4.0 / 3).value * (3 + excess_of_second(k)) - 3);
    }
    const double second = 3 * std::expm1(std::log1p(excess_of_second(k) / 3) - 4.0 / 3 * std::log1p(k.j));
    return c10 * IsochoricFirst(k).excess + c01 * second;
  }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const {
    const Eigen::Matrix3d g = twice_strain(k);
    if (k.is_low()) {
      const OfJ power = k.continued_power(-4.0 / 3);
      return c10 * IsochoricFirst(k).gradient + c01 * power.value * slope_of_second(k) +
             c01 * power.slope * (3 + excess_of_second(k)) * k.cofactor;
    }
    // I1 F - F C - 2/3 I2 F^-T without the large terms that cancel.
    const Eigen::Matrix3d deviator = k.f * (g.trace() * Eigen::Matrix3d::Identity() - g) +
                                     (2 * k.difference - 2.0 / 3 * excess_of_second(k) * k.cofactor) / (1 + k.j);
    return c10 * IsochoricFirst(k).gradient + 2 * c01 * scale_of_second(k) * deviator;
  }
  void add_tangent(const Kinematics& k, Matrix9d& out) const {
    IsochoricFirst(k).add_curvature(k, c10, out);
    const OfJ power = k.is_low() ? k.continued_power(-4.0 / 3) : OfJ{scale_of_second(k)};
    const Eigen::Matrix3d c = k.f.transpose() * k.f, b = k.f * k.f.transpose(), slope = slope_of_second(k);
    const double first = c.trace(), second = 3 + excess_of_second(k), scale = c01 * power.value;
    out += 2 * scale * first * Matrix9d::Identity();
    add_product(out, 4 * scale, k.f, k.f);
    add_crossed(out, -2 * scale, k.f);
    for (int r = 0; r < 9; ++r) {
      for (int s = 0; s < 9; ++s) {
        if (r / 3 == s / 3) out(r, s) -= 2 * scale * c(s % 3, r % 3);
        if (r % 3 == s % 3) out(r, s) -= 2 * scale * b(r / 3, s / 3);
      }
    }
    if (k.is_low()) {
      add_function_of_j(out, c01, power, second, slope, k);
      return;
    }
    const Eigen::Matrix3d q = k.inverse_transposed();
    add_product(out, -4.0 / 3 * scale, q, slope);
    add_product(out, -4.0 / 3 * scale, slope, q);
    add_product(out, 16.0 / 9 * scale * second, q, q);
    add_crossed(out, 4.0 / 3 * scale * second, q);
  }

 private:
  /// C - I.
  static Eigen::Matrix3d twice_strain(const Kinematics& k) { return k.h + k.h.transpose() + k.h.transpose() * k.h; }
  /// I2 - 3.
  static double excess_of_second(const Kinematics& k) {
    const Eigen::Matrix3d g = twice_strain(k);
    return 2 * g.trace() + 0.5 * (g.trace() * g.trace() - g.squaredNorm());
  }
  /// dI2/dF
  static Eigen::Matrix3d slope_of_second(const Kinematics& k) {
    const Eigen::Matrix3d c = k.f.transpose() * k.f;
    return 2 * (c.trace() * k.f - k.f * c);
  }
  static double scale_of_second(const Kinematics& k) { return std::exp(-4.0 / 3 * std::log1p(k.j)); }
};

}  // namespace pliant::laws
