// What tools hold, through an edit of the bodies.
#pragma once
#include "simulation/state/run_context.h"

namespace pliant {

/// Whether a tool of the model can hold tissue.
[[nodiscard]] bool has_grips(const Model& model);

/// Gives the points of contact of `next`, the model of `program`, the places at which tools hold those of the loaded model that
/// rest where they do. Call before `program` is loaded.
void carry_grips(const RunContext& run, const Model& next, Program& program);

}  // namespace pliant
