// The forces that hold a body and move it as prescribed.
#pragma once
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// What fixes or moves each node of a body [N], in the order of ModelBody::rest; 0 in components that are free: m (a + c v - g)
/// - (R - F) at the present state, a and v by central differences of what is prescribed over one step. Nodes that shape
/// matching moves have no such force: 0.
std::vector<Vec3d> reactions(Simulation& simulation, std::size_t body);

}  // namespace pliant
