// W = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2, hence P = mu J^-2/3 (F - s cof F) + kappa (J - 1) cof F with s = I1 / (3 J).
#pragma once
#include "cpu_ref/cube_root.h"
#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/laws/inversion.h"

namespace pliant::ref {

template <class Scalar>
struct IsochoricNeoHookean {
  static constexpr bool invertible = false;
  Scalar low, mu, kappa;

  explicit IsochoricNeoHookean(const Scalar* law_parameters)
      : low(law_parameters[0]), mu(law_parameters[1]), kappa(law_parameters[2]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar pressure,
                                                               Low is_low) const {
    const Scalar jacobian = Scalar(1) + d.j;
    const Scalar root = inverse_cube_root(jacobian);
    const Scalar hh = squared_norm(d.h);
    const Scalar third = Scalar(1) / (Scalar(3) * jacobian);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;  // 3 J (1 - s)
    const Scalar one_minus_s = excess * third;
    const Scalar s = std::fma(-excess, third, Scalar(1));
    const Scalar low_d = low_distance(d.j), squared = root * root, low_power = low_first(low_d);
    const Scalar power = mu * (is_low ? low_power : squared), m = scale * power;
    const Scalar p = scale * pressure;
    const Scalar low_difference = std::fma(scale * mu, low_first_slope(low_d) * (Scalar(3) + std::fma(Scalar(2), d.t, hh)), -p);
    const Scalar high_difference = std::fma(m, s, -p);
    const Scalar difference = is_low ? low_difference : high_difference;
    const Scalar low_identity = std::fma(-difference, d.t, std::fma(scale, power, -difference));
    const Scalar identity = std::fma(p, d.t, std::fma(m, std::fma(-s, d.t, one_minus_s), p));
    return combine(d, is_low ? low_identity : identity, m, difference, -difference);
  }
};

}  // namespace pliant::ref
