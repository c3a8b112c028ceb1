// Reduces relative motion within elements that would invert within a few steps.
#pragma once
#include <cstdint>

#include "simulation/state/run_context.h"

namespace pliant {

/// Where the nodes of an element move relative to their mean by more than `share` of its edge in one step, which is faster
/// than waves in the element, the relative motion is reduced to that, like a plastic impact: momentum is conserved and
/// kinetic energy decreases. If nodes of the element are held, the motion relative to them is reduced and they take up
/// momentum. An element that shares no node with another is reduced to a fifth of that.
struct Calmed {
  std::int64_t elements = 0;  ///< number of elements whose motion was reduced
  double fastest = 0;         ///< largest relative motion of an element's nodes before, in edges per step
};
Calmed calm(RunContext& run, double share);

}  // namespace pliant
