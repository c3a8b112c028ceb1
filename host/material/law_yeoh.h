// Yeoh's law (Yeoh 1993) of the isochoric first invariant, with a volumetric part:
//   W = c10 x + c20 x^2 + c30 x^3 + U(J),  x = J^-2/3 I1 - 3
#pragma once
#include "material/isochoric.h"
#include "material/law.h"

namespace pliant::laws {

struct Yeoh {
  static constexpr ParameterInfo parameters[]{
      {"c10", "Pa", least_modulus, most_modulus, "half the shear modulus at rest"},
      {"c20", "Pa", -most_modulus, most_modulus, "coefficient of the square; mostly negative for rubber, positive for tissue"},
      {"c30", "Pa", -most_modulus, most_modulus, "coefficient of the cube: the stiffening at large strain"},
      {"kappa", "Pa", least_modulus, most_modulus, "bulk modulus"},
  };
  static constexpr LawInfo info{.word = "yeoh",
                                .energy = "c10 x + c20 x^2 + c30 x^3 + kappa/2 (J - 1)^2, x = J^-2/3 I1 - 3",
                                .source = "Yeoh 1993",
                                .parameters = parameters,
                                .takes_moduli = false,
                                .volumetric = true,
                                .invertible = false,
                                .flops = 136};
  double c10, c20, c30, kappa;

  explicit Yeoh(const double* p) : c10(p[0]), c20(p[1]), c30(p[2]), kappa(p[3]) {}
  static std::vector<double> from_moduli(const Moduli& m) { return {m.mu / 2, m.mu / 20, m.mu / 100, m.kappa}; }
  [[nodiscard]] Moduli moduli() const { return Moduli::from_bulk(2 * c10, kappa); }
  [[nodiscard]] std::vector<double> constants() const { return {2 * c10, 4 * c20, 6 * c30, kappa}; }

  [[nodiscard]] double bulk() const { return kappa; }
  [[nodiscard]] double energy(const Kinematics& k) const {
    const double x = IsochoricFirst(k).excess;
    return x * (c10 + x * (c20 + x * c30));
  }
  [[nodiscard]] Eigen::Matrix3d stress(const Kinematics& k) const {
    const IsochoricFirst first(k);
    return slope(first.excess) * first.gradient;
  }
  void add_tangent(const Kinematics& k, Matrix9d& out) const {
    const IsochoricFirst first(k);
    first.add_curvature(k, slope(first.excess), out);
    add_product(out, 2 * c20 + 6 * c30 * first.excess, first.gradient, first.gradient);
  }

 private:
  /// dW/dx
  [[nodiscard]] double slope(double x) const { return c10 + x * (2 * c20 + x * 3 * c30); }
};

}  // namespace pliant::laws
