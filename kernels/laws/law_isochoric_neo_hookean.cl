// W = mu/2 (J^-2/3 I1 - 3) + kappa/2 (J - 1)^2.
//   P = mu J^-2/3 (F - s cof F) + kappa (J - 1) cof F,  s = I1 / (3 J).
// With hh = |H|^2: I1 = 3 + 2 t + hh and 1 - s = (t + 3 q - hh) / (3 J), free of cancellation at small strain.

#include "cube_root.cl"
#define LAW_INVERTIBLE 0
typedef struct {
  float low, mu, kappa;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2]};
  return m;
}
static inline real law_pressure(law m, real j) { return m.kappa * j; }

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const real jacobian = 1.0f + d.j;
  const real root = inverse_cube_root(jacobian);
  const real hh = squared_norm(d.h);
  const real third = 1.0f / (3.0f * jacobian);
  const real excess = fma(3.0f, d.q, d.t) - hh;  // 3 J (1 - s)
  const real one_minus_s = excess * third;
  const real s = fma(-excess, third, 1.0f);
  const real low_d = low_distance(d.j);
  const real power = m.mu * (low ? low_first(low_d) : root * root), g = scale * power;
  const real p = scale * pressure;
  const real difference =
      low ? fma(scale * m.mu, low_first_slope(low_d) * (3.0f + fma(2.0f, d.t, hh)), -p) : fma(g, s, -p);
  const real identity = low ? fma(-difference, d.t, fma(scale, power, -difference))
                            : fma(p, d.t, fma(g, fma(-s, d.t, one_minus_s), p));
  return combine(d, identity, g, difference, -difference);
}
