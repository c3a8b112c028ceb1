// W = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2, hence P = mu J^-2/3 (F - s cof F) + kappa (J - 1) cof F with s = I1 / (3 J).
#pragma once
#include <bit>
#include <cstdint>

#include "deformation.h"

namespace pliant::ref {

/// A first guess of x^(-1/3) for x > 0, within 4 %: a third of the exponent, taken on the bits.
inline float guess_inverse_cube_root(float x) {
  return std::bit_cast<float>(std::int32_t{0x54A2FA8C} - std::bit_cast<std::int32_t>(x) / 3);
}
inline double guess_inverse_cube_root(double x) {
  return std::bit_cast<double>(std::int64_t{0x553EF0FF289DD796} - std::bit_cast<std::int64_t>(x) / 3);
}

/// x^(-1/3) for x > 0 by four Newton steps y <- y (4 - x y^3) / 3.
template <class Scalar>
inline Scalar inverse_cube_root(Scalar x) {
  Scalar y = guess_inverse_cube_root(x);
  for (int i = 0; i < 4; ++i) y = y * std::fma(Scalar(-1.0L / 3), (x * y) * (y * y), Scalar(4.0L / 3));
  return y;
}

template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> isochoric_neo_hookean_stress(const Deformation<Scalar>& d, Scalar scale, Scalar p0,
                                                                        Scalar pressure) {
  const Mat3<Scalar>& h = d.h;
  const Scalar jacobian = Scalar(1) + d.j;
  const Scalar root = inverse_cube_root(jacobian);
  const Scalar hh = add_dot3(add_dot3(dot3(h.m00, h.m00, h.m01, h.m01, h.m02, h.m02), h.m10, h.m10, h.m11, h.m11, h.m12, h.m12),
                             h.m20, h.m20, h.m21, h.m21, h.m22, h.m22);  // |H|^2
  const Scalar third = Scalar(1) / (Scalar(3) * jacobian);
  const Scalar excess = std::fma(Scalar(3), d.q, d.t) - hh;  // 3 J (1 - s)
  const Scalar one_minus_s = excess * third;
  const Scalar s = std::fma(-excess, third, Scalar(1));
  const Scalar m = scale * (p0 * (root * root));
  const Scalar p = scale * pressure;
  const Scalar difference = std::fma(m, s, -p);
  return combine(d, std::fma(p, d.t, std::fma(m, std::fma(-s, d.t, one_minus_s), p)), m, difference, -difference);
}

}  // namespace pliant::ref
