// The material law of a batch. A twin of a fragment is a class template
//   static constexpr bool invertible                                whether the law is finite for J <= 0 too
//   Name(const Scalar* law_parameters)                              the parameters [Pa], or what the host makes of them
//   Scalar pressure(Scalar j)                                       dU/dJ [Pa] of the volumetric part at j = J - 1
//   Mat3<Scalar> stress(deformation, scale, pressure)               `scale` (a volume) times the first Piola-Kirchhoff stress
#pragma once
#include "laws.h"
#include "twin_laws.h"

namespace pliant::ref {

template <int Number, class Scalar>
struct LawOf;

#define PLIANT_TWIN(stem, Type)                       \
  template <class Scalar>                             \
  struct LawOf<static_cast<int>(Law::stem), Scalar> { \
    using type = Type<Scalar>;                        \
  };
PLIANT_LAWS(PLIANT_TWIN)
#undef PLIANT_TWIN

/// The law whose number is the define LAW.
template <int Number, class Scalar>
using MaterialLaw = typename LawOf<Number, Scalar>::type;

/// True where the law has no stress: J is not finite, or not positive though the law needs that (inverted, collapsed).
template <class LawType, class Scalar>
inline bool is_faulty(const LawType&, const Deformation<Scalar>& d) {
  constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  const Scalar jacobian = Scalar(1) + d.j;
  if constexpr (LawType::invertible) return !(std::fabs(jacobian) < infinity);
  return !(jacobian > Scalar(0)) || !(jacobian < infinity);
}

}  // namespace pliant::ref
