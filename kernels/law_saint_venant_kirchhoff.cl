// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S;   p0 = mu, p1 = lambda.
static inline mat3 law_stress(deformation d, real scale, float p0, float p1, real pressure) {
  const mat3 h = d.h;
  const real e00 = fma(0.5f, fma(h.m20, h.m20, fma(h.m10, h.m10, h.m00 * h.m00)), h.m00);
  const real e11 = fma(0.5f, fma(h.m21, h.m21, fma(h.m11, h.m11, h.m01 * h.m01)), h.m11);
  const real e22 = fma(0.5f, fma(h.m22, h.m22, fma(h.m12, h.m12, h.m02 * h.m02)), h.m22);
  const real g01 = fma(h.m20, h.m21, fma(h.m10, h.m11, h.m00 * h.m01)) + (h.m01 + h.m10);  // 2 E01
  const real g02 = fma(h.m20, h.m22, fma(h.m10, h.m12, h.m00 * h.m02)) + (h.m02 + h.m20);
  const real g12 = fma(h.m21, h.m22, fma(h.m11, h.m12, h.m01 * h.m02)) + (h.m12 + h.m21);
  const real mu = scale * p0;
  const real two_mu = 2.0f * mu;
  const real l = (scale * p1) * ((e00 + e11) + e22);
  const real s00 = fma(two_mu, e00, l), s11 = fma(two_mu, e11, l), s22 = fma(two_mu, e22, l);
  const real s01 = mu * g01, s02 = mu * g02, s12 = mu * g12;
  mat3 p;
  p.m00 = fma(h.m02, s02, fma(h.m01, s01, fma(h.m00, s00, s00)));
  p.m01 = fma(h.m02, s12, fma(h.m01, s11, fma(h.m00, s01, s01)));
  p.m02 = fma(h.m02, s22, fma(h.m01, s12, fma(h.m00, s02, s02)));
  p.m10 = fma(h.m12, s02, fma(h.m11, s01, fma(h.m10, s00, s01)));
  p.m11 = fma(h.m12, s12, fma(h.m11, s11, fma(h.m10, s01, s11)));
  p.m12 = fma(h.m12, s22, fma(h.m11, s12, fma(h.m10, s02, s12)));
  p.m20 = fma(h.m22, s02, fma(h.m21, s01, fma(h.m20, s00, s02)));
  p.m21 = fma(h.m22, s12, fma(h.m21, s11, fma(h.m20, s01, s12)));
  p.m22 = fma(h.m22, s22, fma(h.m21, s12, fma(h.m20, s02, s22)));
  return p;
}
