// The rotation of a region by Horn's quaternion; kernels/matching/flsm_rotation.cl explains the method.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cpu_ref/elements/deformation.h"
#include "layout.h"

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

/// Horn's matrices of a tile's regions, entry by entry, while they are squared. Settled matrices stay as they are.
template <class Scalar>
struct HornTile {
  Scalar n00[PLIANT_TILE], n01[PLIANT_TILE], n02[PLIANT_TILE], n03[PLIANT_TILE], n11[PLIANT_TILE], n12[PLIANT_TILE],
      n13[PLIANT_TILE], n22[PLIANT_TILE], n23[PLIANT_TILE], n33[PLIANT_TILE];
  std::int32_t settled[PLIANT_TILE];

  [[gnu::always_inline]] Symmetric4<Scalar> at(int l) const {
    return {n00[l], n01[l], n02[l], n03[l], n11[l], n12[l], n13[l], n22[l], n23[l], n33[l]};
  }
  [[gnu::always_inline]] void set(int l, const Symmetric4<Scalar>& n) {
    n00[l] = n.n00, n01[l] = n.n01, n02[l] = n.n02, n03[l] = n.n03, n11[l] = n.n11;
    n12[l] = n.n12, n13[l] = n.n13, n22[l] = n.n22, n23[l] = n.n23, n33[l] = n.n33;
  }
};

/// Share of tr^2 - tr(n^2) at which two more squarings leave nothing but the largest eigenvalue.
template <class Scalar>
constexpr Scalar settled_share = Scalar(0.025f);
template <>
inline constexpr double settled_share<double> = 1e-4;

/// Squares every matrix until it has one eigenvalue, at most 16 times.
template <class Scalar>
inline void square_until_settled(HornTile<Scalar>& tile) {
  for (int k = 0; k < 8; ++k) {
    std::int32_t all = 1;
    for (int l = 0; l < PLIANT_TILE; ++l) all &= tile.settled[l];
    if (all != 0) return;
    for (int l = 0; l < PLIANT_TILE; ++l) {
      const Symmetric4<Scalar> before = tile.at(l), n = normalised(before), n2 = squared(n), n4 = squared(n2);
      const Scalar trace = (n.n00 + n.n11) + (n.n22 + n.n33), trace2 = (n2.n00 + n2.n11) + (n2.n22 + n2.n33);
      const bool done = tile.settled[l] != 0, last = std::fma(trace, trace, -trace2) <= settled_share<Scalar> * (trace * trace);
      const auto pick = [&](Scalar old, Scalar next) { return done ? old : next; };
      tile.set(l, {pick(before.n00, n4.n00), pick(before.n01, n4.n01), pick(before.n02, n4.n02), pick(before.n03, n4.n03),
                   pick(before.n11, n4.n11), pick(before.n12, n4.n12), pick(before.n13, n4.n13), pick(before.n22, n4.n22),
                   pick(before.n23, n4.n23), pick(before.n33, n4.n33)});
      tile.settled[l] = static_cast<std::int32_t>(done || last);
    }
  }
}

/// Horn's matrix of a + e (a: xx yy zz xy xz yz), scaled and shifted.
template <class Scalar>
[[gnu::always_inline]] inline Symmetric4<Scalar> horn_matrix(const Scalar (&a)[6], const Mat3<Scalar>& e, Scalar size,
                                                             bool& ok) {
  const Scalar b00 = a[0] + e.m00, b01 = a[3] + e.m01, b02 = a[4] + e.m02;
  const Scalar b10 = a[3] + e.m10, b11 = a[1] + e.m11, b12 = a[5] + e.m12;
  const Scalar b20 = a[4] + e.m20, b21 = a[5] + e.m21, b22 = a[2] + e.m22;
  const Scalar first = std::fma(b02, b02, std::fma(b01, b01, b00 * b00));
  const Scalar second = std::fma(b12, b12, std::fma(b11, b11, std::fma(b10, b10, first)));
  const Scalar f2 = std::fma(b22, b22, std::fma(b21, b21, std::fma(b20, b20, second)));
  const Scalar least = Scalar(1e-12f) * size;
  ok = (f2 > least * least) & (f2 < std::numeric_limits<Scalar>::infinity());
  const Scalar scale = ok ? Scalar(1) / std::sqrt(f2) : Scalar(0), shift = Scalar(0.625);
  return {std::fma((b00 + b11) + b22, scale, shift),
          (e.m21 - e.m12) * scale,
          (e.m02 - e.m20) * scale,
          (e.m10 - e.m01) * scale,
          std::fma((b00 - b11) - b22, scale, shift),
          (b01 + b10) * scale,
          (b02 + b20) * scale,
          std::fma((b11 - b00) - b22, scale, shift),
          (b12 + b21) * scale,
          std::fma((b22 - b00) - b11, scale, shift)};
}

/// R - I from a matrix whose columns are multiples of the quaternion.
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> rotation_from(const Symmetric4<Scalar>& n) {
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
