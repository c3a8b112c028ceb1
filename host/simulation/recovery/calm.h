// Takes motion out of elements that would turn inside out within a few steps.
#pragma once
#include <cstdint>

#include "simulation/state/run_context.h"

namespace pliant {

/// Where the nodes of an element move against each other by more than `share` of its edge in one step, faster than its own
/// waves could carry, that relative motion is brought down to this, as by a plastic impact: momentum stays, kinetic energy only
/// falls. Where nodes of the element are held, it is the motion against those, and they take momentum up. An element that
/// shares no node with another keeps a fifth of it.
struct Calmed {
  std::int64_t elements = 0;
  double fastest = 0;  ///< largest motion of an element's nodes against each other before, in edges per step
};
Calmed calm(RunContext& run, double share);

}  // namespace pliant
