// The integrator of a pass. A twin of a fragment is a struct
//   Scalar w_of(Scalar now, Scalar next)              node_w of a component that is moved from `now` to `next`; linear in both
//   void advance(Scalar& u, Scalar& w, Drive, Step)   a step of one component from what node_u and node_w hold
#pragma once
#include <cmath>

#include "integrators.h"

namespace pliant::ref {

/// Parameters shared by all nodes of a pass.
template <class Scalar>
struct StepParameters {
  Scalar h, half_hh, gravity[3], still, fine, anchor;
  explicit StepParameters(const Scalar* step_params)
      : h(step_params[0]),
        half_hh((Scalar(0.5) * step_params[0]) * step_params[0]),
        gravity{step_params[1], step_params[2], step_params[3]},
        still(step_params[4]),
        fine(step_params[5]),
        anchor(Scalar(3) * step_params[5]) {}
  /// Returns 0 for an increment below the floor.
  Scalar increment(Scalar w) const { return std::fabs(w) < still ? Scalar(0) : w; }
  /// Rounds a small displacement to the grid.
  Scalar displacement(Scalar u) const { return std::fabs(u) < fine ? (u + anchor) - anchor : u; }
};

/// Input of a component's step: R - F [N], 1/m [1/kg], gravity [m/s^2] and the node's decay from the host (host/integrators).
template <class Scalar>
struct Drive {
  Scalar force, inverse_mass, gravity, decay;
  /// `share` h^2 (R - F) / m and the same for gravity [m]. Slots without a node do not move.
  [[nodiscard]] Scalar push(Scalar share) const {
    const Scalar free = inverse_mass > Scalar(0) ? share : Scalar(0);
    return std::fma(share * inverse_mass, force, free * gravity);
  }
};

}  // namespace pliant::ref

#include "twin_integrators.h"

namespace pliant::ref {

template <int Number>
struct IntegratorOf;

#define PLIANT_TWIN(stem, Type)                             \
  template <>                                               \
  struct IntegratorOf<static_cast<int>(Integrator::stem)> { \
    using type = integrators::Type;                         \
  };
PLIANT_INTEGRATORS(PLIANT_TWIN)
#undef PLIANT_TWIN

/// The integrator selected by the define INTEGRATOR.
template <int Number>
using StepForm = typename IntegratorOf<Number>::type;

}  // namespace pliant::ref
