// What stands in tools, through an edit of the bodies and a change of the step.
#pragma once
#include "simulation/state/run_context.h"

namespace pliant {

/// Points of contact of `next`, the model of `program`, that hang on other nodes than before, or are new, may lie deep in a
/// tool; they are marked, so that the first step sees how deep (contact_start). The others keep what they had. Call before
/// `program` is loaded.
void carry_depths(const RunContext& run, const Model& next, Program& program);
/// The same after an edit that leaves nodes and points as they were, when `program` has the values of all of them.
void mark_freed(const RunContext& run, const Model& next, Program& program);
/// When the step has become `ratio` times as long. A depth that a force of the elements keeps up is proportional to the square
/// of the step; taken back in a much shorter one, it would throw the tissue out at its depth over that step. There contact goes
/// on with the forces that it had, and the depth is left.
void follow_step(const RunContext& run, double ratio);

}  // namespace pliant
