// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S.
// No part of it depends on J alone. It is finite for every F, but loses its resistance as J approaches 0: below J = 1/4 (low) W has the additional
// term c/3 (low - J)^3, c = 16 (lambda + 2 mu), which adds -c (low - J)^2 cof F.
#include "green_strain.cl"
#define LAW_INVERTIBLE 0
typedef struct {
  float low, mu, lambda;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2]};
  return m;
}
static inline real law_pressure(law m, real j) {
  const real none = 0.0f;
  return none;
}

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const sym3 e = green_strain(d.h);
  const real mu = scale * m.mu;
  const real two_mu = 2.0f * mu;
  const real l = (scale * m.lambda) * ((e.m00 + e.m11) + e.m22);
  const sym3 s = {fma(two_mu, e.m00, l), fma(two_mu, e.m11, l), fma(two_mu, e.m22, l), mu * e.m01, mu * e.m02, mu * e.m12};
  const mat3 p = times_gradient(d.h, s);
  const real below = 4.0f * (m.low - (1.0f + d.j));
  const real y = -((scale * fma(2.0f, m.mu, m.lambda)) * (below * below));
  const real one = 1.0f + d.t;
#define BARRIER(ij, cofactor) r.ij = low ? fma(y, cofactor, p.ij) : p.ij
  mat3 r;
  BARRIER(m00, (one - d.h.m00) + d.c.m00);
  BARRIER(m01, d.c.m01 - d.h.m10);
  BARRIER(m02, d.c.m02 - d.h.m20);
  BARRIER(m10, d.c.m10 - d.h.m01);
  BARRIER(m11, (one - d.h.m11) + d.c.m11);
  BARRIER(m12, d.c.m12 - d.h.m21);
  BARRIER(m20, d.c.m20 - d.h.m02);
  BARRIER(m21, d.c.m21 - d.h.m12);
  BARRIER(m22, (one - d.h.m22) + d.c.m22);
  return r;
}
