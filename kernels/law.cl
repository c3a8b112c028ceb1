// The material law of this batch: first Piola-Kirchhoff stress P = F S times `scale` (a volume).
//   mat3 law_stress(deformation d, real scale, float p0, float p1, real pressure)
// p0, p1: the law's two parameters [Pa]; pressure: dU/dJ [Pa] of the volumetric part U(J), p1 (J - 1) or its nodal average.
#include "deformation.cl"
#if LAW == PLIANT_LAW_NEO_HOOKEAN
#include "law_neo_hookean.cl"
#elif LAW == PLIANT_LAW_SAINT_VENANT_KIRCHHOFF
#include "law_saint_venant_kirchhoff.cl"
#elif LAW == PLIANT_LAW_ISOCHORIC_NEO_HOOKEAN
#include "law_isochoric_neo_hookean.cl"
#endif
