// Viscous stress in addition to that of the law, a Kelvin-Voigt solid: S_v = 2 eta dev(D) + zeta tr(D) I, second Piola-Kirchhoff, where D = (E_n -
// E_(n-1)) / h is the rate of Green's strain over the last step. With W = F_n - F_(n-1) and M = F_n - W / 2
//   E_n - E_(n-1) = sym(M^T W), exactly,   P_v = M S_v
// So a rigid motion of the step, however large, causes no force; the work in the step, P_v : W = S_v : (E_n - E_(n-1)), is never negative; and the
// forces have no moment about the mid-step positions, because M S_v M^T is symmetric (Simo and Tarnow 1992). viscosity: 2 eta, zeta - 2 eta / 3 [Pa
// s]; step_params: h [s]. Without VISCOUS, these and node_w are not read.
#if VISCOUS
// h += a (x) b, of a corner.
#define ADD_CORNER(h, ax, ay, az, bx, by, bz)                                                                \
  (h).m00 = fma(ax, bx, (h).m00), (h).m01 = fma(ax, by, (h).m01), (h).m02 = fma(ax, bz, (h).m02);            \
  (h).m10 = fma(ay, bx, (h).m10), (h).m11 = fma(ay, by, (h).m11), (h).m12 = fma(ay, bz, (h).m12);            \
  (h).m20 = fma(az, bx, (h).m20), (h).m21 = fma(az, by, (h).m21), (h).m22 = fma(az, bz, (h).m22);

// Adds `scale` P_v to p; h: F_n - I.
static inline mat3 add_viscous(mat3 p, mat3 h, mat3 w, real scale, __global const float* viscosity, __global const float* step_params) {
  const float rate = 1.0f / step_params[0], shear = viscosity[0] * rate, half_shear = 0.5f * shear, volume = viscosity[1] * rate;
  const mat3 m = {fma(-0.5f, w.m00, h.m00), fma(-0.5f, w.m01, h.m01), fma(-0.5f, w.m02, h.m02),
                  fma(-0.5f, w.m10, h.m10), fma(-0.5f, w.m11, h.m11), fma(-0.5f, w.m12, h.m12),
                  fma(-0.5f, w.m20, h.m20), fma(-0.5f, w.m21, h.m21), fma(-0.5f, w.m22, h.m22)};  // M - I
#define STRETCH(i, j) fma(m.m2##i, w.m2##j, fma(m.m1##i, w.m1##j, fma(m.m0##i, w.m0##j, w.m##i##j)))  // (M^T W)_ij
  const real e00 = STRETCH(0, 0), e11 = STRETCH(1, 1), e22 = STRETCH(2, 2);
  const real spherical = volume * ((e00 + e11) + e22);
  const real s00 = fma(shear, e00, spherical), s11 = fma(shear, e11, spherical), s22 = fma(shear, e22, spherical);
  const real s01 = half_shear * (STRETCH(0, 1) + STRETCH(1, 0)), s02 = half_shear * (STRETCH(0, 2) + STRETCH(2, 0));
  const real s12 = half_shear * (STRETCH(1, 2) + STRETCH(2, 1));
#define STRESS(i, j, s0, s1, s2, own) fma(scale, fma(m.m##i##2, s2, fma(m.m##i##1, s1, fma(m.m##i##0, s0, own))), p.m##i##j)
  const mat3 sum = {STRESS(0, 0, s00, s01, s02, s00), STRESS(0, 1, s01, s11, s12, s01), STRESS(0, 2, s02, s12, s22, s02),
                    STRESS(1, 0, s00, s01, s02, s01), STRESS(1, 1, s01, s11, s12, s11), STRESS(1, 2, s02, s12, s22, s12),
                    STRESS(2, 0, s00, s01, s02, s02), STRESS(2, 1, s01, s11, s12, s12), STRESS(2, 2, s02, s12, s22, s22)};
  return sum;
}
#endif
