// W = c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2; law_parameters: 2 c10, 2 c01, kappa.
//   P = 2 c10 J^-2/3 (F - s cof F) + 2 c01 J^-4/3 Q + kappa (J - 1) cof F,  s = I1 / (3 J),  Q = I1 F - F F^T F - 2/3 I2 F^-T
// With G = F^T F - I, g = tr G, z = (g^2 - tr G^2) / 2: I2 = 3 + 2 g + z and, free of cancellation at small strain,
//   Q = F (g I - G) + 2/J (J F - cof F) - w cof F,  w = 2 (2 g + z) / (3 J).
#include "cube_root.cl"
#include "green_strain.cl"
#define LAW_INVERTIBLE 0
typedef struct {
  float low, first, second, kappa;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2], law_parameters[3]};
  return m;
}
static inline real law_pressure(law m, real j) { return m.kappa * j; }

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const sym3 e = green_strain(d.h);  // G / 2 on the diagonal, G off the diagonal
  const real jacobian = 1.0f + d.j;
  const real root = inverse_cube_root(jacobian), squared = root * root;
  const real inverse = 1.0f / jacobian, third = 1.0f / (3.0f * jacobian);
  const real hh = squared_norm(d.h);
  const real excess = fma(3.0f, d.q, d.t) - hh;  // 3 J (1 - s)
  const real s = fma(-excess, third, 1.0f);
  const real diagonal = fma(e.m00, e.m11, fma(e.m11, e.m22, e.m00 * e.m22));
  const real z = fma(4.0f, diagonal, -fma(e.m01, e.m01, fma(e.m02, e.m02, e.m12 * e.m12)));
  const real i2 = fma(4.0f, (e.m00 + e.m11) + e.m22, z);  // I2 - 3
  const real w = (2.0f * third) * i2;

  const real low_d = low_distance(d.j);
  const real a = scale * (m.first * (low ? low_first(low_d) : squared));
  const real b = scale * (m.second * (low ? low_second(low_d) : squared * squared)), twice_b = 2.0f * b;
  const real p = scale * pressure;
  const real volumetric = fma(-b, w, p);
  const real low_difference = fma(scale * m.first, low_first_slope(low_d) * (3.0f + fma(2.0f, d.t, hh)),
                                  fma(scale * m.second, low_second_slope(low_d) * (3.0f + i2), -p));
  const real difference = low ? low_difference : fma(a, s, fma(b, w, fma(twice_b, inverse, -p)));
  const real whole = fma(2.0f, b, a);
  const real identity = low ? fma(-difference, d.t, whole - difference)
                            : fma(a, fma(-s, d.t, excess * third),
                                  fma(twice_b * inverse, d.q, fma(volumetric, d.t, volumetric)));
  const mat3 x = combine(d, identity, whole, difference, -difference);
  const sym3 g = {twice_b * (e.m11 + e.m22), twice_b * (e.m00 + e.m22), twice_b * (e.m00 + e.m11), -b * e.m01, -b * e.m02, -b * e.m12};
  const mat3 y = times_gradient(d.h, g);
  const mat3 sum = {x.m00 + y.m00, x.m01 + y.m01, x.m02 + y.m02, x.m10 + y.m10, x.m11 + y.m11,
                    x.m12 + y.m12, x.m20 + y.m20, x.m21 + y.m21, x.m22 + y.m22};
  return sum;
}
