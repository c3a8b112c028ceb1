// Dynamic relaxation: damping that follows the lowest mode still moving, until the body is at rest.
#pragma once
#include "simulation/state/run_context.h"

namespace pliant {

/// Damp the lowest mode that still moves critically, c = 2 omega with omega^2 = - du . df / (du . M du) from the change of
/// displacement and force since the last change of the damping (Papadrakakis 1981; Joldes, Wittek and Miller 2009), and look
/// for equilibrium. Where what is left of the fast motion is what rounding excites, the change is measured over as many steps
/// as it takes to stand out from that, and so is the residual. With shape matching all forces are taken from the change of
/// momentum.
void relax(RunContext& run);

}  // namespace pliant
