// The energies of a run at its present time.
#pragma once
#include <vector>

#include "simulation/measure/energy.h"

namespace pliant {

struct RunContext;

/// As energies(), with the kinetic energy that the integrator conserves (IntegratorInfo::squared_velocity): that of either
/// velocity around the step oscillates by omega h. `contact`: forces of contact on the nodes in the last step by slot [N]; of a
/// node that they hold in balance they count for the next velocity, too, so that tissue under a tool that moves has the
/// velocity that it has.
Energies energies_now(const RunContext& run, const std::vector<Vec3d>& contact = {});

}  // namespace pliant
