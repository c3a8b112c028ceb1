// Replaces the tools of a running simulation.
#pragma once
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Go on with a model that is the present one but for its tools (model_with_tools); `before` and `next` are the tools of both.
/// The motion, what tissue holds of tissue and what sticks to tools that stay go on as they are. Throws, with all as it was,
/// what Backend::load throws.
void load_tools(RunContext& run, const std::shared_ptr<const Model>& model, const std::vector<ContactTool>& before,
                const std::vector<ContactTool>& next);

/// Nothing sticks to this tool of the model any more, and it may be near anything: it was put elsewhere.
void let_go(RunContext& run, std::size_t tool);

}  // namespace pliant
