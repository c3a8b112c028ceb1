// The material law of a batch: `scale` (a volume) times the first Piola-Kirchhoff stress P.
#pragma once
#include "law_isochoric_neo_hookean.h"
#include "law_neo_hookean.h"
#include "law_saint_venant_kirchhoff.h"
#include "layout.h"

namespace pliant::ref {

constexpr int law_count = 3;

/// p0, p1: the law's two parameters [Pa]; pressure: dU/dJ [Pa] of the volumetric part.
template <int Law, class Scalar>
[[gnu::always_inline]] inline Mat3<Scalar> law_stress(const Deformation<Scalar>& d, Scalar scale, Scalar p0, Scalar p1,
                                                      Scalar pressure) {
  if constexpr (Law == PLIANT_LAW_NEO_HOOKEAN) return neo_hookean_stress(d, scale, p0, pressure);
  if constexpr (Law == PLIANT_LAW_SAINT_VENANT_KIRCHHOFF) return saint_venant_kirchhoff_stress(d, scale, p0, p1);
  if constexpr (Law == PLIANT_LAW_ISOCHORIC_NEO_HOOKEAN) return isochoric_neo_hookean_stress(d, scale, p0, pressure);
}

}  // namespace pliant::ref
