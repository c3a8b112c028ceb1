// The loads that a scene and a program put on a body.
#pragma once
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// What acts on each node of a body from outside now [N], in the order of ModelBody::rest: its weight, the forces of the scene
/// and of the host (Simulation::set_forces), and its part of the pressures on the deformed surface (a third of a triangle's at
/// each vertex, from there to the nodes that move it). Not what fixes or prescribes nodes (reactions.h), and nothing elastic.
/// In double and from the Model alone.
std::vector<Vec3d> applied_loads(const Simulation& simulation, std::size_t body);

}  // namespace pliant
