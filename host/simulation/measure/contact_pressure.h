// Pressure of contact on the surface.
#pragma once
#include <vector>

#include "simulation/simulation.h"

namespace pliant {

/// One value per vertex of the surface [Pa]: the force of contact in the last step along the deformed inward normal, per
/// undeformed area. Forces and areas of contact points are distributed to their nodes and from there to the vertices, so that
/// a point spreads over about two cells, and the sum over the surface is the force. 0 where nothing touches.
std::vector<float> contact_pressures(const Simulation& simulation);

}  // namespace pliant
