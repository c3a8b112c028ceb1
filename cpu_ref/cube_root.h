// The inverse cube root for isochoric laws, without library functions (docs/determinism.md).
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace pliant::ref {

/// Initial guess of x^(-1/3) for x > 0, within 4 %: a third of the exponent, computed on the bits.
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

}  // namespace pliant::ref
