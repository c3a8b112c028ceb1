// W = c10 x + c20 x^2 + c30 x^3 + kappa/2 (J - 1)^2 with x = J^-2/3 I1 - 3; law_parameters: 2 c10, 4 c20, 6 c30, kappa.
//   P = (2 c10 + 4 c20 x + 6 c30 x^2) J^-2/3 (F - s cof F) + kappa (J - 1) cof F,  s = I1 / (3 J)
// With hh = |H|^2: I1 = 3 + 2 t + hh and 1 - s = (t + 3 q - hh) / (3 J), free of cancellation at small strain.
#include "cube_root.cl"
#define LAW_INVERTIBLE 0
typedef struct {
  float low, first, second, third, kappa;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2], law_parameters[3], law_parameters[4]};
  return m;
}
static inline real law_pressure(law m, real j) { return m.kappa * j; }

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const real jacobian = 1.0f + d.j;
  const real root = inverse_cube_root(jacobian), squared = root * root;
  const real hh = squared_norm(d.h);
  const real third = 1.0f / (3.0f * jacobian);
  const real excess = fma(3.0f, d.q, d.t) - hh;  // 3 J (1 - s)
  const real s = fma(-excess, third, 1.0f);
  const real low_d = low_distance(d.j);
  const real power = low ? low_first(low_d) : squared, i1 = 3.0f + fma(2.0f, d.t, hh);
  const real x = fma(power, i1, -3.0f);
  const real slope = fma(x, fma(m.third, x, m.second), m.first);
  const real factor = slope * power, g = scale * factor;
  const real p = scale * pressure;
  const real difference = low ? fma(scale * slope, low_first_slope(low_d) * i1, -p) : fma(g, s, -p);
  const real identity = low ? fma(-difference, d.t, fma(scale, factor, -difference))
                            : fma(p, d.t, fma(g, fma(-s, d.t, excess * third), p));
  return combine(d, identity, g, difference, -difference);
}
