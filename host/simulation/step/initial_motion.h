// The first increments of a simulation.
#pragma once
#include "simulation/state/run_context.h"

namespace pliant {

/// Sets node_w to what leads from the initial velocities and the forces of the first configuration to the first step.
void set_initial_motion(const RunContext& run);

}  // namespace pliant
