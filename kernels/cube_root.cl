// x^(-1/3) for x > 0: initial guess from the exponent bits, then four Newton steps y <- y (4 - x y^3) / 3.
static inline real inverse_cube_root(real x) {
#if LANES == 16
  real y = as_float16((integer)(0x54A2FA8C) - as_int16(x) / 3);
#else
  real y = as_float(0x54A2FA8C - as_int(x) / 3);
#endif
  for (int i = 0; i < 4; ++i) y = y * fma(-0.333333343f, (x * y) * (y * y), 1.33333337f);
  return y;
}
