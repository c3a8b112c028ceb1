// The material law of a batch. A twin of a fragment is a class template
//   static constexpr bool invertible                                whether the law is finite for J <= 0 as it is
//   Scalar low                                                      below this J the law is continued (inversion.h)
//   Name(const Scalar* law_parameters)                              the parameters [Pa], or what the host makes of them
//   Scalar pressure(Scalar j)                                       dU/dJ [Pa] of the volumetric part at j = J - 1
//   Mat3<Scalar> stress(deformation, scale, pressure, low)          `scale` (a volume) times the first Piola-Kirchhoff stress;
//                                                                   low: is_low(law, deformation), or std::false_type if it
//                                                                   is known not to be
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/tile.h"
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

/// The law selected by the define LAW.
template <int Number, class Scalar>
using MaterialLaw = typename LawOf<Number, Scalar>::type;

constexpr std::int32_t no_fault = 0, inverted = 1, lost = 2;
/// inverted: J <= 0, and the law is continued; lost: no stress, because J is not finite, or not positive where the law is
/// undefined.
template <class LawType, class Scalar>
inline std::int32_t fault_of(const LawType& law, const Deformation<Scalar>& d) {
  constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  const Scalar jacobian = Scalar(1) + d.j;
  const bool finite = std::fabs(jacobian) < infinity;
  if (jacobian > Scalar(0) && finite) return no_fault;
  return finite && (LawType::invertible || law.low > Scalar(0)) ? inverted : lost;
}

/// Returns true if J is so low that the law is continued by polynomials.
template <class LawType, class Scalar>
inline bool is_low(const LawType& law, const Deformation<Scalar>& d) {
  return Scalar(1) + d.j < law.low;
}

/// Marks the faults of elements begin .. end - 1 of a row (tile.h), of which `dilation` has J - 1; where `fill` is 0 is none.
template <class LawType, class Scalar, std::size_t Count>
inline void mark_faults(const LawType& law, const Scalar (&dilation)[Count], const Scalar* fill, std::int64_t begin,
                        std::int64_t end, std::int32_t step, std::int32_t* fault) {
  constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  bool sound = true;
  for (const Scalar j : dilation) sound &= Scalar(1) + j > Scalar(0) && Scalar(1) + j < infinity;
  if (sound) return;
  for (std::int64_t e = begin; e < end; ++e) {
    Deformation<Scalar> d{};
    d.j = dilation[e];
    mark_fault(fill[e] > Scalar(0) ? fault_of(law, d) : no_fault, step, fault[e]);
  }
}

}  // namespace pliant::ref
