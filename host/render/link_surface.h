// Triangles of the springs of joins and of lists, and of vessels, for pictures.
#pragma once
#include <cstdint>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::render {

/// The body number of triangles that belong to springs, and to vessels.
inline constexpr std::int32_t kSpringBody = -2, kVesselBody = -3;

/// Appends a prism around each of them, where it is now, behind the vertices (x, y, z), the triangles and their bodies that are
/// there. Vessels are as thick as the scene says, springs thin. Those that are broken have no size, so that the triangles stay
/// as many while no edit changes them. Springs along the edges of elements are not shown.
void append_links(Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles,
                  std::vector<std::int32_t>& bodies);

}  // namespace pliant::render
