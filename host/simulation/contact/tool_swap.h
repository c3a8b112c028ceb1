// Replaces the tools of a running simulation.
#pragma once
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Loads a model that differs from the current one only in its tools (model_with_tools); `before` and `next` are the tools of
/// both. Preserves the motion, tissue-tissue contact and sticking friction at tools that remain. Throws what Backend::load
/// throws and then changes nothing.
void load_tools(RunContext& run, const std::shared_ptr<const Model>& model, const std::vector<ContactTool>& before,
                const std::vector<ContactTool>& next);

/// Replaces the distances of a tool whose grid stays: its shape has changed. Everything else stays.
void replace_shape(RunContext& run, std::size_t tool, const ToolForm& form);

/// Releases sticking friction at a tool of the model, for a tool that was placed elsewhere.
void let_go(RunContext& run, std::size_t tool);

}  // namespace pliant
