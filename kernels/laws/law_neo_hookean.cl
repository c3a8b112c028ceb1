// S = mu (I - C^-1) + lambda J (J - 1) C^-1 (Hybrid Deformation Model, equation 12),
// from W = mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2.
//   P = mu/J (J F - cof F) + lambda (J - 1) cof F.
#define LAW_INVERTIBLE 0
typedef struct {
  float low, mu, lambda;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2]};
  return m;
}
static inline real law_pressure(law m, real j) { return m.lambda * j; }

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const real jacobian = 1.0f + d.j;
  const real ratio = low ? m.mu * low_inverse(low_distance(d.j)) : m.mu / jacobian;
  const real s = scale * ratio;
  const real p = scale * pressure;
  const real difference = fma(scale, ratio, -p);  // s - p
  const real whole = scale * m.mu;  // s J where J is not low
  const real identity = low ? fma(-difference, d.t, fma(scale, m.mu, -difference)) : fma(p, d.t, fma(s, d.q, p));
  return combine(d, identity, low ? whole : fma(s, d.j, s), difference, -difference);
}
