// W = c10 x + c20 x^2 + c30 x^3 + kappa/2 (J - 1)^2 with x = J^-2/3 I1 - 3; the derivation is in kernels/law_yeoh.cl.
#pragma once
#include "cube_root.h"
#include "deformation.h"

namespace pliant::ref {

template <class Scalar>
struct Yeoh {
  static constexpr bool invertible = false;
  Scalar first, second, third, kappa;  ///< 2 c10, 4 c20, 6 c30, kappa

  explicit Yeoh(const Scalar* law_parameters)
      : first(law_parameters[0]), second(law_parameters[1]), third(law_parameters[2]), kappa(law_parameters[3]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale,
                                                               Scalar pressure) const {
    const Scalar jacobian = Scalar(1) + d.j;
    const Scalar root = inverse_cube_root(jacobian), squared = root * root;
    const Scalar hh = squared_norm(d.h);
    const Scalar inverse = Scalar(1) / (Scalar(3) * jacobian);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;
    const Scalar s = std::fma(-excess, inverse, Scalar(1));
    const Scalar x = std::fma(squared, Scalar(3) + std::fma(Scalar(2), d.t, hh), Scalar(-3));
    const Scalar g = scale * (std::fma(x, std::fma(third, x, second), first) * squared);
    const Scalar p = scale * pressure;
    const Scalar difference = std::fma(g, s, -p);
    return combine(d, std::fma(p, d.t, std::fma(g, std::fma(-s, d.t, excess * inverse), p)), g, difference, -difference);
  }
};

}  // namespace pliant::ref
