// The rotation of a region by Horn's quaternion; kernels/matching/flsm_rotation.cl explains the method.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cpu_ref/elements/deformation.h"

namespace pliant::ref {

/// Symmetric 4 x 4 matrix; entry (i, j) with i <= j at row i.
template <class Scalar>
struct Symmetric4 {
  Scalar n00, n01, n02, n03, n11, n12, n13, n22, n23, n33;
};

template <class Scalar>
[[gnu::always_inline]] inline Symmetric4<Scalar> squared(const Symmetric4<Scalar>& n) {
  const auto dot4 = [](Scalar a0, Scalar b0, Scalar a1, Scalar b1, Scalar a2, Scalar b2, Scalar a3, Scalar b3) {
    return std::fma(a3, b3, std::fma(a2, b2, std::fma(a1, b1, a0 * b0)));
  };
  return {dot4(n.n00, n.n00, n.n01, n.n01, n.n02, n.n02, n.n03, n.n03),
          dot4(n.n00, n.n01, n.n01, n.n11, n.n02, n.n12, n.n03, n.n13),
          dot4(n.n00, n.n02, n.n01, n.n12, n.n02, n.n22, n.n03, n.n23),
          dot4(n.n00, n.n03, n.n01, n.n13, n.n02, n.n23, n.n03, n.n33),
          dot4(n.n01, n.n01, n.n11, n.n11, n.n12, n.n12, n.n13, n.n13),
          dot4(n.n01, n.n02, n.n11, n.n12, n.n12, n.n22, n.n13, n.n23),
          dot4(n.n01, n.n03, n.n11, n.n13, n.n12, n.n23, n.n13, n.n33),
          dot4(n.n02, n.n02, n.n12, n.n12, n.n22, n.n22, n.n23, n.n23),
          dot4(n.n02, n.n03, n.n12, n.n13, n.n22, n.n23, n.n23, n.n33),
          dot4(n.n03, n.n03, n.n13, n.n13, n.n23, n.n23, n.n33, n.n33)};
}

/// The power of two that brings x into [1, 2).
inline float scale_to_one(float x) {
  return std::bit_cast<float>(0x7f000000U - (std::bit_cast<std::uint32_t>(x) & 0x7f800000U));
}
inline double scale_to_one(double x) {
  return std::bit_cast<double>(0x7fe0000000000000ULL - (std::bit_cast<std::uint64_t>(x) & 0x7ff0000000000000ULL));
}

/// Scales the trace to [1, 2) and rounds entries to a grid of 2^-31 (in double 2^-60).
template <class Scalar>
[[gnu::always_inline]] inline Symmetric4<Scalar> normalised(const Symmetric4<Scalar>& n) {
  constexpr Scalar grid = Scalar(0.005859375);
  const Scalar scale = scale_to_one((n.n00 + n.n11) + (n.n22 + n.n33));
  const auto on_grid = [&](Scalar x) { return std::fma(x, scale, grid) - grid; };
  return {on_grid(n.n00), on_grid(n.n01), on_grid(n.n02), on_grid(n.n03), on_grid(n.n11),
          on_grid(n.n12), on_grid(n.n13), on_grid(n.n22), on_grid(n.n23), on_grid(n.n33)};
}

/// R - I for the rotation R closest to a + e (a: xx yy zz xy xz yz); see kernels/matching/flsm_rotation.cl.
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> rotation_of(const Scalar (&a)[6], const Mat3<Scalar>& e, Scalar size, bool& ok) {
  const Scalar b00 = a[0] + e.m00, b01 = a[3] + e.m01, b02 = a[4] + e.m02;
  const Scalar b10 = a[3] + e.m10, b11 = a[1] + e.m11, b12 = a[5] + e.m12;
  const Scalar b20 = a[4] + e.m20, b21 = a[5] + e.m21, b22 = a[2] + e.m22;
  Scalar f2 = b00 * b00;
  for (const Scalar b : {b01, b02, b10, b11, b12, b20, b21, b22}) f2 = std::fma(b, b, f2);
  const Scalar least = Scalar(1e-12f) * size;
  ok = f2 > least * least && f2 < std::numeric_limits<Scalar>::infinity();
  const Scalar scale = ok ? Scalar(1) / std::sqrt(f2) : Scalar(0), shift = Scalar(1.7320508f);
  Symmetric4<Scalar> n{std::fma((b00 + b11) + b22, scale, shift),
                       (e.m21 - e.m12) * scale,
                       (e.m02 - e.m20) * scale,
                       (e.m10 - e.m01) * scale,
                       std::fma((b00 - b11) - b22, scale, shift),
                       (b01 + b10) * scale,
                       (b02 + b20) * scale,
                       std::fma((b11 - b00) - b22, scale, shift),
                       (b12 + b21) * scale,
                       std::fma((b22 - b00) - b11, scale, shift)};
  for (int k = 0; k < 8; ++k) n = squared(squared(normalised(n)));
  Scalar w = n.n00, x = n.n01, y = n.n02, z = n.n03, largest = n.n00;
  const auto take = [&](Scalar c0, Scalar c1, Scalar c2, Scalar c3, Scalar diagonal) {
    const bool larger = diagonal > largest;
    w = larger ? c0 : w;
    x = larger ? c1 : x;
    y = larger ? c2 : y;
    z = larger ? c3 : z;
    largest = larger ? diagonal : largest;
  };
  take(n.n01, n.n11, n.n12, n.n13, n.n11);
  take(n.n02, n.n12, n.n22, n.n23, n.n22);
  take(n.n03, n.n13, n.n23, n.n33, n.n33);
  const Scalar unit = Scalar(1) / largest;
  w = w * unit, x = x * unit, y = y * unit, z = z * unit;
  const Scalar two = Scalar(2) / std::fma(z, z, std::fma(y, y, std::fma(x, x, w * w)));
  const Scalar x2 = two * x, y2 = two * y, z2 = two * z;
  return {minus(std::fma(y2, y, z2 * z)), std::fma(x2, y, -(z2 * w)),     std::fma(x2, z, y2 * w),
          std::fma(x2, y, z2 * w),        minus(std::fma(x2, x, z2 * z)), std::fma(y2, z, -(x2 * w)),
          std::fma(x2, z, -(y2 * w)),     std::fma(y2, z, x2 * w),        minus(std::fma(x2, x, y2 * y))};
}

}  // namespace pliant::ref
