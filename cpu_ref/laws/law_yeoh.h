// W = c10 x + c20 x^2 + c30 x^3 + kappa/2 (J - 1)^2 with x = J^-2/3 I1 - 3; the derivation is in kernels/laws/law_yeoh.cl.
#pragma once
#include "cpu_ref/cube_root.h"
#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/laws/inversion.h"

namespace pliant::ref {

template <class Scalar>
struct Yeoh {
  static constexpr bool invertible = false;
  Scalar low, first, second, third, kappa;  ///< 2 c10, 4 c20, 6 c30, kappa

  explicit Yeoh(const Scalar* law_parameters)
      : low(law_parameters[0]),
        first(law_parameters[1]),
        second(law_parameters[2]),
        third(law_parameters[3]),
        kappa(law_parameters[4]) {}
  [[nodiscard]] Scalar pressure(Scalar j) const { return kappa * j; }

  template <class Low>
  [[nodiscard, gnu::always_inline]] inline Mat3<Scalar> stress(const Deformation<Scalar>& d, Scalar scale, Scalar pressure,
                                                               Low is_low) const {
    const Scalar jacobian = Scalar(1) + d.j;
    const Scalar root = inverse_cube_root(jacobian), squared = root * root;
    const Scalar hh = squared_norm(d.h);
    const Scalar inverse = Scalar(1) / (Scalar(3) * jacobian);
    const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;
    const Scalar s = std::fma(-excess, inverse, Scalar(1));
    const Scalar low_d = low_distance(d.j), low_power = low_first(low_d);
    const Scalar power = is_low ? low_power : squared, i1 = Scalar(3) + std::fma(Scalar(2), d.t, hh);
    const Scalar x = std::fma(power, i1, Scalar(-3));
    const Scalar slope = std::fma(x, std::fma(third, x, second), first);
    const Scalar factor = slope * power, g = scale * factor;
    const Scalar p = scale * pressure;
    const Scalar low_difference = std::fma(scale * slope, low_first_slope(low_d) * i1, -p),
                 high_difference = std::fma(g, s, -p);
    const Scalar difference = is_low ? low_difference : high_difference;
    const Scalar low_identity = std::fma(-difference, d.t, std::fma(scale, factor, -difference));
    const Scalar identity = std::fma(p, d.t, std::fma(g, std::fma(-s, d.t, excess * inverse), p));
    return combine(d, is_low ? low_identity : identity, g, difference, -difference);
  }
};

}  // namespace pliant::ref
