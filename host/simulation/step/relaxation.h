// Dynamic relaxation: damping adapted to the lowest mode that still moves, until equilibrium.
#pragma once
#include "simulation/state/run_context.h"

namespace pliant {

/// Updates the damping and checks for equilibrium. The lowest moving mode is damped critically, c = 2 omega with omega^2 = -
/// du . df / (du . M du), where du and df are the changes of displacement and force since the last update (Papadrakakis 1981;
/// Joldes, Wittek and Miller 2009). Once the remaining fast motion is only rounding noise, the changes and the residual are
/// measured over as many steps as they need to exceed that noise. With shape matching, all forces are derived from the change
/// of momentum.
void relax(RunContext& run);

}  // namespace pliant
