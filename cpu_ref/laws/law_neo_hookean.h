// S = mu (I - C^-1) + lambda J (J - 1) C^-1, hence P = mu/J (J F - cof F) + lambda (J - 1) cof F.
#pragma once
#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/laws/inversion.h"

namespace pliant::ref {

template <class Scalar>
struct NeoHookean {
  static constexpr bool invertible = false;
  Scalar low, mu, lambda;

  explicit NeoHookean(const Scalar* law_parameters)
      : low(law_parameters[0]), mu(law_parameters[1]), lambda(law_parameters[2]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return lambda * j; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar pressure,
                                                               Low is_low) const {
    const Scalar jacobian = Scalar(1) + d.j;
    const Scalar low_ratio = mu * low_inverse(low_distance(d.j)), high_ratio = mu / jacobian;
    const Scalar ratio = is_low ? low_ratio : high_ratio;
    const Scalar s = scale * ratio;
    const Scalar p = scale * pressure;
    const Scalar difference = std::fma(scale, ratio, -p);
    const Scalar whole = scale * mu, high_whole = std::fma(s, d.j, s);
    const Scalar low_identity = std::fma(-difference, d.t, std::fma(scale, mu, -difference)),
                 identity = std::fma(p, d.t, std::fma(s, d.q, p));
    return combine(d, is_low ? low_identity : identity, is_low ? whole : high_whole, difference, -difference);
  }
};

}  // namespace pliant::ref
