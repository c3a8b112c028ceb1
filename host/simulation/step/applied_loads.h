// External loads on the nodes of a body.
#pragma once
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// Returns the external force on each node of a body [N], in the order of ModelBody::rest: weight, the forces of the scene
/// and of the host (Simulation::set_forces), and the pressures on the deformed surface, of which each vertex of a triangle
/// gets a third and passes it on to the nodes that move it. Excludes reactions (reactions.h) and internal forces. Computed in
/// double from the Model alone.
std::vector<Vec3d> applied_loads(const Simulation& simulation, std::size_t body);

}  // namespace pliant
