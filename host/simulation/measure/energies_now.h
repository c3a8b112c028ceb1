// The energies of a run at its present time.
#pragma once
#include "simulation/measure/energy.h"

namespace pliant {

struct RunContext;

/// As energies(), with the kinetic energy that the integrator conserves (IntegratorInfo::squared_velocity): that of either
/// velocity around the step oscillates by omega h.
Energies energies_now(const RunContext& run);

}  // namespace pliant
