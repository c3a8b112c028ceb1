// Changes the added inertia (ballast) of nodes in a running simulation.
#pragma once
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"
#include "simulation/state/snapshot.h"

namespace pliant {

/// Replaces the current ballast. A node that becomes heavier keeps its momentum, one that becomes lighter keeps its velocity,
/// so that no energy is added. Throws what Backend::load throws and then changes nothing.
void load_ballast(RunContext& run, std::vector<NodeInertia> ballast);

/// Loads `model`, which has the nodes of the present one, with the state in `snapshot`.
void load_with_state(RunContext& run, std::shared_ptr<const Model> model, const Snapshot& snapshot);

}  // namespace pliant
