// The tools of a run state: those of the scene, plus added ones, minus removed and parked ones.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/blade_face.h"
#include "simulation/state/run_state.h"

namespace pliant {

/// Returns the remaining tools of the scene, then the added ones, including parked tools.
std::vector<ContactTool> known_tools(const Scene& scene, const ToolChanges& changes);
/// The same without parked tools: the tools of the model.
std::vector<ContactTool> present_tools(const Scene& scene, const ToolChanges& changes);
[[nodiscard]] bool is_parked(const ToolChanges& changes, const std::string& name);

/// Validates changes that may come from a checkpoint. Throws Error (bad_input) if no host could have made them to this scene.
void check_tool_changes(const Scene& scene, const ToolChanges& changes);

/// Returns the pose of a tool at a time [s].
[[nodiscard]] Pose tool_pose(const ContactTool& tool, const RunState& state, double time);
/// Returns the strength of a tool's grip while it grips [Pa]; 0: it cannot.
[[nodiscard]] double grip_strength(const ContactTool& tool);
/// Returns true for a face of a blade that is not in the scene at a time [s].
[[nodiscard]] bool is_away(const ContactTool& tool, const RunState& state, double time);
/// Returns the strength of a tool's grip at a time [Pa]; 0: it does not grip.
[[nodiscard]] double tool_grip(const ContactTool& tool, const RunState& state, double time);

/// Returns a copy of `model` with the tools `next`. Shapes that are in `known` or that `model` has (for the tools `before`) are
/// reused; others are built from the surfaces that the host has given or from their files. Throws what tool_form() throws.
std::shared_ptr<Model> model_with_tools(const Scene& scene, const Model& model, const std::vector<ContactTool>& before,
                                        const std::vector<ContactTool>& next, const std::map<std::string, GivenSurfaces>& given,
                                        const std::vector<const ToolForm*>& known = {});

/// The present shape of a tool, also of a parked one.
ToolForm present_form(const ContactTool& tool, const std::map<std::string, GivenSurfaces>& given);

/// Throws Error (usage) for a tool that cannot hold tissue.
void check_grip(const ContactTool& tool);
/// Throws Error (usage) for a tool whose shape cannot change.
void check_takes_surfaces(const ContactTool& tool);

}  // namespace pliant
