// Reaction forces of fixed and prescribed nodes.
#pragma once
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// Returns the reaction on each node of a body [N], in the order of ModelBody::rest; 0 in free components. It is m (a + c v -
/// g) - (R - F) at the current state, with a and v from central differences of the prescribed motion over one step. Nodes
/// moved by shape matching have none: 0.
std::vector<Vec3d> reactions(Simulation& simulation, std::size_t body);

}  // namespace pliant
