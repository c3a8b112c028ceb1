// S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (H + H^T + H^T H) / 2;   P = S + H S.
// No part of it depends on J alone.
#include "green_strain.cl"
#define LAW_INVERTIBLE 0
typedef struct {
  float mu, lambda;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1]};
  return m;
}
static inline real law_pressure(law m, real j) {
  const real none = 0.0f;
  return none;
}

static inline mat3 law_stress(deformation d, real scale, law m, real pressure) {
  const sym3 e = green_strain(d.h);
  const real mu = scale * m.mu;
  const real two_mu = 2.0f * mu;
  const real l = (scale * m.lambda) * ((e.m00 + e.m11) + e.m22);
  const sym3 s = {fma(two_mu, e.m00, l), fma(two_mu, e.m11, l), fma(two_mu, e.m22, l), mu * e.m01, mu * e.m02, mu * e.m12};
  return times_gradient(d.h, s);
}
