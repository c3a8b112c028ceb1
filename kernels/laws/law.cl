// The material law of a batch, selected by the define LAW (laws.h). Its fragment law_STEM.cl defines
//   law                                                  its parameters [Pa] or values that the host derives from them, after float low:
//                                                        below this J the law is continued (inversion.cl)
//   LAW_INVERTIBLE                                       1: the law is finite for J <= 0 without continuation
//   law law_load(__global const float* law_parameters)   loads the parameters, the same for a batch: called once, before any loop
//   real law_pressure(law m, real j)                     dU/dJ [Pa] of the volumetric part U(J) at j = J - 1; 0 if it has none
//   INLINE mat3 law_stress(deformation d, real scale, law m, real pressure, integer low)
// low: J < m.low. law_stress returns the first Piola-Kirchhoff stress P = F S times `scale` (a volume); `pressure` is law_pressure or its nodal
// average.
#include "deformation.cl"
#include "inversion.cl"
#include "laws.cl"

#define NO_FAULT 0
#define INVERTED 1  // J <= 0, and the law is continued
#define LOST 2      // no stress: J is not finite, or not positive where the law is undefined
static inline integer fault_of(deformation d, law m) {
  const real jacobian = 1.0f + d.j;
  const integer none = NO_FAULT, inverted = INVERTED, lost = LOST;
  const integer positive = jacobian > 0.0f, finite = fabs(jacobian) < INFINITY;
#if LAW_INVERTIBLE
  const integer goes_on = finite;
#else
  const integer goes_on = finite && (real)(m.low) > 0.0f;
#endif
  return positive && finite ? none : goes_on ? inverted : lost;
}

// law_stress of the existing elements, and their fault `kind`. Elements below m.low and faults are rare, so one branch, which is nearly always
// uniform over a group of sixteen, skips their extra work.
static inline mat3 stress_of(deformation d, real scale, law m, real pressure, integer exists, integer* kind) {
  const real jacobian = 1.0f + d.j;
  const integer none = NO_FAULT, usual = jacobian >= (m.low > FLT_MIN ? m.low : FLT_MIN) && jacobian < INFINITY;
  mat3 p = law_stress(d, scale, m, pressure, none);
  *kind = none;
  if (ANY(!usual)) {  // padding is not deformed
    *kind = exists ? fault_of(d, m) : none;
    p = law_stress(d, scale, m, pressure, jacobian < m.low);
  }
  return p;
}
