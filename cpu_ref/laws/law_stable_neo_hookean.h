// P = mu (F - cof F) + mu r F + lambda' (J - 1) cof F, finite for every F; the derivation is in
// kernels/laws/law_stable_neo_hookean.cl.
#pragma once
#include "cpu_ref/elements/deformation.h"

namespace pliant::ref {

template <class Scalar>
struct StableNeoHookean {
  static constexpr bool invertible = true;
  Scalar low, mu, lambda;  ///< mu, lambda' = lambda + 5/6 mu

  explicit StableNeoHookean(const Scalar* law_parameters)
      : low(law_parameters[0]), mu(law_parameters[1]), lambda(law_parameters[2]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return lambda * j; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar pressure,
                                                               Low /*is_low*/) const {
    const Scalar e = std::fma(Scalar(2), d.t, squared_norm(d.h));
    const Scalar ratio = e / std::fma(Scalar(3), e, Scalar(12));
    const Scalar m = scale * mu;
    const Scalar p = scale * pressure;
    const Scalar difference = std::fma(scale, pressure, -m);
    return combine(d, std::fma(difference, d.t, std::fma(m, ratio, p)), std::fma(m, ratio, m), -difference, difference);
  }
};

}  // namespace pliant::ref
