// W = mu'/2 (I1 - 3) - mu'/2 ln(I1 + 1) + lambda'/2 (J - alpha)^2, alpha = 1 + 3 mu' / (4 lambda'), with mu' = 4/3 mu, lambda' =
// lambda + 5/6 mu, so that mu and lambda are those of linear elasticity; law_parameters: mu, lambda'.
//   P = mu' (1 - 1 / (I1 + 1)) F - 3/4 mu' cof F + lambda' (J - 1) cof F
//     = mu (F - cof F) + mu r F + lambda' (J - 1) cof F,  r = e / (3 (4 + e)),  e = I1 - 3 = 2 t + |H|^2
// There is no division by J: the law is finite for every F.
#define LAW_INVERTIBLE 1
typedef struct {
  float low, mu, lambda;
} law;
static inline law law_load(__global const float* law_parameters) {
  const law m = {law_parameters[0], law_parameters[1], law_parameters[2]};
  return m;
}
static inline real law_pressure(law m, real j) { return m.lambda * j; }

INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low) {
  const real e = fma(2.0f, d.t, squared_norm(d.h));
  const real ratio = e / fma(3.0f, e, 12.0f);
  const real mu = scale * m.mu;
  const real p = scale * pressure;
  const real difference = fma(scale, pressure, -mu);
  return combine(d, fma(difference, d.t, fma(mu, ratio, p)), fma(mu, ratio, mu), -difference, difference);
}
