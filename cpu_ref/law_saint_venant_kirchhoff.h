// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S.
#pragma once
#include "deformation.h"

namespace pliant::ref {

template <class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> saint_venant_kirchhoff_stress(const Deformation<Scalar>& d, Scalar scale, Scalar p0,
                                                                         Scalar p1) {
  const Mat3<Scalar>& h = d.h;
  const Scalar half = Scalar(0.5);
  const Scalar e00 = std::fma(half, dot3(h.m00, h.m00, h.m10, h.m10, h.m20, h.m20), h.m00);
  const Scalar e11 = std::fma(half, dot3(h.m01, h.m01, h.m11, h.m11, h.m21, h.m21), h.m11);
  const Scalar e22 = std::fma(half, dot3(h.m02, h.m02, h.m12, h.m12, h.m22, h.m22), h.m22);
  const Scalar twice_e01 = dot3(h.m00, h.m01, h.m10, h.m11, h.m20, h.m21) + (h.m01 + h.m10);
  const Scalar twice_e02 = dot3(h.m00, h.m02, h.m10, h.m12, h.m20, h.m22) + (h.m02 + h.m20);
  const Scalar twice_e12 = dot3(h.m01, h.m02, h.m11, h.m12, h.m21, h.m22) + (h.m12 + h.m21);
  const Scalar mu = scale * p0;
  const Scalar two_mu = Scalar(2) * mu;
  const Scalar l = (scale * p1) * ((e00 + e11) + e22);
  const Scalar s00 = std::fma(two_mu, e00, l), s11 = std::fma(two_mu, e11, l), s22 = std::fma(two_mu, e22, l);
  const Scalar s01 = mu * twice_e01, s02 = mu * twice_e02, s12 = mu * twice_e12;
  Mat3<Scalar> p;
  p.m00 = add_dot3(s00, h.m00, s00, h.m01, s01, h.m02, s02);
  p.m01 = add_dot3(s01, h.m00, s01, h.m01, s11, h.m02, s12);
  p.m02 = add_dot3(s02, h.m00, s02, h.m01, s12, h.m02, s22);
  p.m10 = add_dot3(s01, h.m10, s00, h.m11, s01, h.m12, s02);
  p.m11 = add_dot3(s11, h.m10, s01, h.m11, s11, h.m12, s12);
  p.m12 = add_dot3(s12, h.m10, s02, h.m11, s12, h.m12, s22);
  p.m20 = add_dot3(s02, h.m20, s00, h.m21, s01, h.m22, s02);
  p.m21 = add_dot3(s12, h.m20, s01, h.m21, s11, h.m22, s12);
  p.m22 = add_dot3(s22, h.m20, s02, h.m21, s12, h.m22, s22);
  return p;
}

}  // namespace pliant::ref
