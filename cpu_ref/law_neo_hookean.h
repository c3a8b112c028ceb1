// S = mu (I - C^-1) + lambda J (J - 1) C^-1, hence P = mu/J (J F - cof F) + lambda (J - 1) cof F.
#pragma once
#include "deformation.h"

namespace pliant::ref {

template <class Scalar>
struct NeoHookean {
  static constexpr bool invertible = false;
  Scalar mu, lambda;

  explicit NeoHookean(const Scalar* law_parameters) : mu(law_parameters[0]), lambda(law_parameters[1]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return lambda * j; }

  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale,
                                                               Scalar pressure) const {
    const Scalar ratio = mu / (Scalar(1) + d.j);
    const Scalar s = scale * ratio;
    const Scalar p = scale * pressure;
    const Scalar difference = std::fma(scale, ratio, -p);
    return combine(d, std::fma(p, d.t, std::fma(s, d.q, p)), std::fma(s, d.j, s), difference, -difference);
  }
};

}  // namespace pliant::ref
