// W = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2.
//   P = mu J^-2/3 (F - s cof F) + kappa (J - 1) cof F,  s = I1 / (3 J);   p0 = mu, p1 = kappa.
// With hh = |H|^2: I1 = 3 + 2 t + hh and 1 - s = (t + 3 q - hh) / (3 J), free of cancellation at small strain.

// x^(-1/3) for x > 0: first guess from the exponent bits, then four Newton steps y <- y (4 - x y^3) / 3.
static inline real inverse_cube_root(real x) {
#if LANES == 16
  real y = as_float16((integer)(0x54A2FA8C) - as_int16(x) / 3);
#else
  real y = as_float(0x54A2FA8C - as_int(x) / 3);
#endif
  for (int i = 0; i < 4; ++i) y = y * fma(-0.333333343f, (x * y) * (y * y), 1.33333337f);
  return y;
}

static inline mat3 law_stress(deformation d, real scale, float p0, float p1, real pressure) {
  const mat3 h = d.h;
  const real jacobian = 1.0f + d.j;
  const real root = inverse_cube_root(jacobian);
  const real hh = fma(h.m22, h.m22, fma(h.m21, h.m21, fma(h.m20, h.m20, fma(h.m12, h.m12, fma(h.m11, h.m11, fma(h.m10, h.m10,
                  fma(h.m02, h.m02, fma(h.m01, h.m01, h.m00 * h.m00))))))));
  const real third = 1.0f / (3.0f * jacobian);
  const real excess = fma(3.0f, d.q, d.t) - hh;  // 3 J (1 - s)
  const real one_minus_s = excess * third;
  const real s = fma(-excess, third, 1.0f);
  const real m = scale * (p0 * (root * root));
  const real p = scale * pressure;
  const real difference = fma(m, s, -p);
  return combine(d, fma(p, d.t, fma(m, fma(-s, d.t, one_minus_s), p)), m, difference, -difference);
}
