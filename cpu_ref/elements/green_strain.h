// Twin of kernels/elements/green_strain.cl.
#pragma once
#include "cpu_ref/elements/deformation.h"

namespace pliant::ref {

template <class Scalar>
struct Sym3 {
  Scalar m00, m11, m22, m01, m02, m12;
};

/// The Green-Lagrange strain E = (H + H^T + H^T H) / 2 on the diagonal, 2 E off the diagonal.
template <class Scalar>
[[gnu::always_inline]] inline Sym3<Scalar> green_strain(const Mat3<Scalar>& h) {
  const Scalar half = Scalar(0.5);
  return {std::fma(half, dot3(h.m00, h.m00, h.m10, h.m10, h.m20, h.m20), h.m00),
          std::fma(half, dot3(h.m01, h.m01, h.m11, h.m11, h.m21, h.m21), h.m11),
          std::fma(half, dot3(h.m02, h.m02, h.m12, h.m12, h.m22, h.m22), h.m22),
          dot3(h.m00, h.m01, h.m10, h.m11, h.m20, h.m21) + (h.m01 + h.m10),
          dot3(h.m00, h.m02, h.m10, h.m12, h.m20, h.m22) + (h.m02 + h.m20),
          dot3(h.m01, h.m02, h.m11, h.m12, h.m21, h.m22) + (h.m12 + h.m21)};
}

/// F S = S + H S.
template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> times_gradient(const Mat3<Scalar>& h, const Sym3<Scalar>& s) {
  Mat3<Scalar> p;
  p.m00 = add_dot3(s.m00, h.m00, s.m00, h.m01, s.m01, h.m02, s.m02);
  p.m01 = add_dot3(s.m01, h.m00, s.m01, h.m01, s.m11, h.m02, s.m12);
  p.m02 = add_dot3(s.m02, h.m00, s.m02, h.m01, s.m12, h.m02, s.m22);
  p.m10 = add_dot3(s.m01, h.m10, s.m00, h.m11, s.m01, h.m12, s.m02);
  p.m11 = add_dot3(s.m11, h.m10, s.m01, h.m11, s.m11, h.m12, s.m12);
  p.m12 = add_dot3(s.m12, h.m10, s.m02, h.m11, s.m12, h.m12, s.m22);
  p.m20 = add_dot3(s.m02, h.m20, s.m00, h.m21, s.m01, h.m22, s.m02);
  p.m21 = add_dot3(s.m12, h.m20, s.m01, h.m21, s.m11, h.m22, s.m12);
  p.m22 = add_dot3(s.m22, h.m20, s.m02, h.m21, s.m12, h.m22, s.m22);
  return p;
}

}  // namespace pliant::ref
