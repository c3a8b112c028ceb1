// Gives nodes of a running simulation inertia, or takes it back.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Go on with this ballast in place of what there is. A node that gets heavier keeps its momentum, one that gets lighter its
/// velocity: no energy comes in. Throws, with all as it was, what Backend::load throws.
void load_ballast(RunContext& run, std::vector<NodeInertia> ballast);

}  // namespace pliant
