// The tools of a scene as a run state has them: with those that the host added, without those that it removed or parked.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "simulation/state/run_state.h"

namespace pliant {

/// The tools of the scene that are still there, then the added ones; parked ones too.
std::vector<ContactTool> known_tools(const Scene& scene, const ToolChanges& changes);
/// The same without those that are parked: the tools of the model.
std::vector<ContactTool> present_tools(const Scene& scene, const ToolChanges& changes);
[[nodiscard]] bool is_parked(const ToolChanges& changes, const std::string& name);

/// Throws Error (bad_input) for changes that no host can have made to this scene. They may have come with a checkpoint.
void check_tool_changes(const Scene& scene, const ToolChanges& changes);

/// Where a tool is at a time [s].
[[nodiscard]] Pose tool_pose(const ContactTool& tool, const RunState& state, double time);

/// A model that is as `model` but for its tools, which are to be `next`. Shapes of tools that `model` has (`before`), and those
/// of `known`, are taken over; others are made of their files. Throws what tool_form() throws.
std::shared_ptr<Model> model_with_tools(const Scene& scene, const Model& model, const std::vector<ContactTool>& before,
                                        const std::vector<ContactTool>& next, const std::vector<const ToolForm*>& known = {});

}  // namespace pliant
