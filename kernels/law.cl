// The material law of this batch, the define LAW (laws.h). Its fragment law_STEM.cl gives
//   law                                                  its parameters [Pa], or what the host makes of them
//   law law_load(__global const float* law_parameters)   the same for all elements of a batch: loaded once, before any loop
//   LAW_INVERTIBLE                                       1: the law is finite for J <= 0 too
//   real law_pressure(law m, real j)                     dU/dJ [Pa] of the volumetric part U(J) at j = J - 1; 0 if it has none
//   mat3 law_stress(deformation d, real scale, law m, real pressure)
// The last is the first Piola-Kirchhoff stress P = F S times `scale` (a volume); `pressure` is law_pressure or its nodal average.
#include "deformation.cl"
#include "laws.cl"

// True where the law has no stress: J is not finite, or not positive though the law needs that (inverted, collapsed).
static inline integer is_faulty(deformation d) {
  const real jacobian = 1.0f + d.j;
#if LAW_INVERTIBLE
  return !(fabs(jacobian) < INFINITY);
#else
  return !(jacobian > 0.0f) || !(jacobian < INFINITY);
#endif
}
