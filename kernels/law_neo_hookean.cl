// S = mu (I - C^-1) + lambda J (J - 1) C^-1 (Hybrid Deformation Model, equation 12),
// from W = mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2.
//   P = mu/J (J F - cof F) + lambda (J - 1) cof F;   p0 = mu, p1 = lambda.
static inline mat3 law_stress(deformation d, real scale, float p0, float p1, real pressure) {
  const real ratio = p0 / (1.0f + d.j);
  const real s = scale * ratio;
  const real p = scale * pressure;
  const real difference = fma(scale, ratio, -p);  // s - p
  return combine(d, fma(p, d.t, fma(s, d.q, p)), fma(s, d.j, s), difference, -difference);
}
