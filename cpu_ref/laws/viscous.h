// Viscous stress in addition to that of the law; the formulas are in kernels/laws/viscous.cl.
#pragma once
#include <cmath>

#include "cpu_ref/elements/deformation.h"

namespace pliant::ref {

template <class Scalar>
struct Viscosity {
  Scalar shear, half_shear, volume;  ///< (2 eta, eta, zeta - 2 eta / 3) / h [Pa]

  Viscosity(const Scalar* viscosity, const Scalar* step_params) {
    const Scalar rate = Scalar(1) / step_params[0];
    shear = viscosity[0] * rate;
    half_shear = Scalar(0.5) * shear;
    volume = viscosity[1] * rate;
  }

  /// Adds `scale` P_v to p; h: F_n - I, w: F_n - F_(n-1).
  [[gnu::always_inline]] inline void add(Mat3<Scalar>& p, const Mat3<Scalar>& h, const Mat3<Scalar>& w, Scalar scale) const {
    const auto mean = [](Scalar of_h, Scalar of_w) { return std::fma(Scalar(-0.5), of_w, of_h); };
    const Scalar m00 = mean(h.m00, w.m00), m01 = mean(h.m01, w.m01), m02 = mean(h.m02, w.m02);
    const Scalar m10 = mean(h.m10, w.m10), m11 = mean(h.m11, w.m11), m12 = mean(h.m12, w.m12);
    const Scalar m20 = mean(h.m20, w.m20), m21 = mean(h.m21, w.m21), m22 = mean(h.m22, w.m22);
    const auto row = [](Scalar a0, Scalar a1, Scalar a2, Scalar b0, Scalar b1, Scalar b2, Scalar own) {
      return std::fma(a2, b2, std::fma(a1, b1, std::fma(a0, b0, own)));
    };
    const Scalar e00 = row(m00, m10, m20, w.m00, w.m10, w.m20, w.m00), e11 = row(m01, m11, m21, w.m01, w.m11, w.m21, w.m11);
    const Scalar e22 = row(m02, m12, m22, w.m02, w.m12, w.m22, w.m22);
    const Scalar e01 = row(m00, m10, m20, w.m01, w.m11, w.m21, w.m01), e10 = row(m01, m11, m21, w.m00, w.m10, w.m20, w.m10);
    const Scalar e02 = row(m00, m10, m20, w.m02, w.m12, w.m22, w.m02), e20 = row(m02, m12, m22, w.m00, w.m10, w.m20, w.m20);
    const Scalar e12 = row(m01, m11, m21, w.m02, w.m12, w.m22, w.m12), e21 = row(m02, m12, m22, w.m01, w.m11, w.m21, w.m21);
    const Scalar spherical = volume * ((e00 + e11) + e22);
    const Scalar s00 = std::fma(shear, e00, spherical), s11 = std::fma(shear, e11, spherical);
    const Scalar s22 = std::fma(shear, e22, spherical);
    const Scalar s01 = half_shear * (e01 + e10), s02 = half_shear * (e02 + e20), s12 = half_shear * (e12 + e21);
    const auto put = [&](Scalar& out, Scalar sum) { out = std::fma(scale, sum, out); };
    put(p.m00, row(m00, m01, m02, s00, s01, s02, s00));
    put(p.m01, row(m00, m01, m02, s01, s11, s12, s01));
    put(p.m02, row(m00, m01, m02, s02, s12, s22, s02));
    put(p.m10, row(m10, m11, m12, s00, s01, s02, s01));
    put(p.m11, row(m10, m11, m12, s01, s11, s12, s11));
    put(p.m12, row(m10, m11, m12, s02, s12, s22, s12));
    put(p.m20, row(m20, m21, m22, s00, s01, s02, s02));
    put(p.m21, row(m20, m21, m22, s01, s11, s12, s12));
    put(p.m22, row(m20, m21, m22, s02, s12, s22, s22));
  }
};

}  // namespace pliant::ref
