// Displacements and velocities of nodes that the host sets.
#pragma once
#include <cstddef>
#include <vector>

#include "geometry/vec3.h"
#include "simulation/state/run_context.h"

namespace pliant {

/// Gives the nodes of a body other displacements [m] and velocities [m/s] (as Simulation::velocities returns them), shape
/// [nodes] each; an empty list leaves what there is, and so do components that the scene holds or moves. Throws Error (usage)
/// for another number of nodes and for numbers that are not finite, and then changes nothing.
void set_nodes(RunContext& run, std::size_t body, const std::vector<Vec3d>& displacements,
               const std::vector<Vec3d>& velocities);

}  // namespace pliant
