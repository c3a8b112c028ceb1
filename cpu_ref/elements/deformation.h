// The displacement gradient H = F - I and the quantities that the material laws use; kernels/elements/deformation.cl has the
// derivation.
#pragma once
#include <cmath>
#include <limits>

#include "cpu_ref/minus.h"

namespace pliant::ref {

template <class Scalar>
struct Mat3 {
  Scalar m00 = 0, m01 = 0, m02 = 0, m10 = 0, m11 = 0, m12 = 0, m20 = 0, m21 = 0, m22 = 0;
};

template <class Scalar>
struct Deformation {
  Mat3<Scalar> h;  ///< H [1]
  Mat3<Scalar> c;  ///< cof H [1]
  Scalar t;        ///< tr H
  Scalar q;        ///< tr cof H + det H
  Scalar j;        ///< J - 1
};

/// a b - c d, the second product rounded first.
template <class Scalar>
inline Scalar minor2(Scalar a, Scalar b, Scalar c, Scalar d) {
  return std::fma(a, b, -(c * d));
}

/// a x + b y + c z, the products added from left to right.
template <class Scalar>
inline Scalar dot3(Scalar a, Scalar x, Scalar b, Scalar y, Scalar c, Scalar z) {
  return std::fma(c, z, std::fma(b, y, a * x));
}

/// s + a x + b y + c z, the products added from left to right.
template <class Scalar>
inline Scalar add_dot3(Scalar s, Scalar a, Scalar x, Scalar b, Scalar y, Scalar c, Scalar z) {
  return std::fma(c, z, std::fma(b, y, std::fma(a, x, s)));
}

template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> cofactor(const Mat3<Scalar>& h) {
  return {minor2(h.m11, h.m22, h.m12, h.m21), minor2(h.m12, h.m20, h.m10, h.m22), minor2(h.m10, h.m21, h.m11, h.m20),
          minor2(h.m02, h.m21, h.m01, h.m22), minor2(h.m00, h.m22, h.m02, h.m20), minor2(h.m01, h.m20, h.m00, h.m21),
          minor2(h.m01, h.m12, h.m02, h.m11), minor2(h.m02, h.m10, h.m00, h.m12), minor2(h.m00, h.m11, h.m01, h.m10)};
}

template <class Scalar>
[[gnu::always_inline]] inline Deformation<Scalar> deformation_of(const Mat3<Scalar>& h) {
  Deformation<Scalar> d;
  // One by one: gcc keeps a copied structure in memory and then does not vectorize the surrounding loop.
  d.h.m00 = h.m00, d.h.m01 = h.m01, d.h.m02 = h.m02;
  d.h.m10 = h.m10, d.h.m11 = h.m11, d.h.m12 = h.m12;
  d.h.m20 = h.m20, d.h.m21 = h.m21, d.h.m22 = h.m22;
  d.c = cofactor(d.h);
  d.t = (d.h.m00 + d.h.m11) + d.h.m22;
  const Scalar det = dot3(d.h.m00, d.c.m00, d.h.m01, d.c.m01, d.h.m02, d.c.m02);
  d.q = ((d.c.m00 + d.c.m11) + d.c.m22) + det;
  d.j = d.t + d.q;
  return d;
}

/// |H|^2; |F|^2 = 3 + 2 tr H + |H|^2.
template <class Scalar>
[[gnu::always_inline]] inline Scalar squared_norm(const Mat3<Scalar>& h) {
  const Scalar first = dot3(h.m00, h.m00, h.m01, h.m01, h.m02, h.m02);
  return add_dot3(add_dot3(first, h.m10, h.m10, h.m11, h.m11, h.m12, h.m12), h.m20, h.m20, h.m21, h.m21, h.m22, h.m22);
}

/// a I + b H + c H^T + e C
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> combine(const Deformation<Scalar>& d, Scalar a, Scalar b, Scalar c, Scalar e) {
  const Mat3<Scalar>&h = d.h, &k = d.c;
  const auto diagonal = [&](Scalar hii, Scalar cii) { return std::fma(e, cii, std::fma(c, hii, std::fma(b, hii, a))); };
  const auto other = [&](Scalar hij, Scalar hji, Scalar cij) { return std::fma(e, cij, std::fma(c, hji, b * hij)); };
  return {diagonal(h.m00, k.m00),     other(h.m01, h.m10, k.m01), other(h.m02, h.m20, k.m02),
          other(h.m10, h.m01, k.m10), diagonal(h.m11, k.m11),     other(h.m12, h.m21, k.m12),
          other(h.m20, h.m02, k.m20), other(h.m21, h.m12, k.m21), diagonal(h.m22, k.m22)};
}

}  // namespace pliant::ref
