#include "simulation/contact/tool_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/contact/contact.h"
#include "pliant/error.h"
#include "scene/tool_entry.h"

namespace pliant {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool ascending(const std::vector<std::string>& names) {
  return std::adjacent_find(names.begin(), names.end(), std::greater_equal<>()) == names.end();
}

}  // namespace

std::vector<ContactTool> known_tools(const Scene& scene, const ToolChanges& changes) {
  std::vector<ContactTool> tools;
  for (const ContactTool& tool : scene.tools) {
    if (!contains(changes.removed, tool.name)) tools.push_back(tool);
  }
  tools.insert(tools.end(), changes.added.begin(), changes.added.end());
  return tools;
}

std::vector<ContactTool> present_tools(const Scene& scene, const ToolChanges& changes) {
  std::vector<ContactTool> tools = known_tools(scene, changes);
  std::erase_if(tools, [&](const ContactTool& tool) { return is_parked(changes, tool.name); });
  return tools;
}

bool is_parked(const ToolChanges& changes, const std::string& name) { return contains(changes.parked, name); }

void check_tool_changes(const Scene& scene, const ToolChanges& changes) {
  if (changes.empty() && changes.given.empty()) return;
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::bad_input, fmt::format("its tools do not belong to this scene, or are damaged: {}", what));
  };
  if (!changes.added.empty()) check_takes_tools(scene);
  const auto of_scene = [&](const std::string& name) {
    return std::any_of(scene.tools.begin(), scene.tools.end(), [&](const ContactTool& t) { return t.name == name; });
  };
  for (const ContactTool& tool : changes.added) check_tool(tool);
  for (const std::string& name : changes.removed) {
    if (!of_scene(name)) refuse(fmt::format("a tool \"{}\" that was removed", name));
  }
  std::set<std::string> names;
  for (const ContactTool& tool : known_tools(scene, changes)) {
    if (tool.name.empty() || !names.insert(tool.name).second) refuse(fmt::format("two tools \"{}\"", tool.name));
  }
  for (const std::string& name : changes.parked) {
    if (!names.contains(name)) refuse(fmt::format("a tool \"{}\" that is parked", name));
  }
  for (const auto& [name, given] : changes.given) {
    const std::vector<ContactTool> known = known_tools(scene, changes);
    const auto named =
        std::find_if(known.begin(), known.end(), [&name = name](const ContactTool& t) { return t.name == name; });
    if (named == known.end()) refuse(fmt::format("the surfaces of a tool \"{}\"", name));
    check_takes_surfaces(*named);
    check_given(name, given);
  }
  if (!ascending(changes.removed) || !ascending(changes.parked)) refuse("names that are not in order");
  const std::size_t present = names.size() - changes.parked.size();
  if (present > most_tools) refuse(fmt::format("{} tools that are not parked, expected at most {}", present, most_tools));
}

Pose tool_pose(const ContactTool& tool, const RunState& state, double time) {
  if (is_face(tool)) return blade_frame(*tool.blade, blade_place(state.driven_blades, *tool.blade, time));
  const ToolDrive* driven = drive_at(state.driven, tool.name, time);
  return driven != nullptr ? driven->at(time) : tool.at(time);
}

bool is_away(const ContactTool& tool, const RunState& state, double time) {
  return is_face(tool) && !blade_present(state.driven_blades, *tool.blade, time, time);
}

double grip_strength(const ContactTool& tool) {
  constexpr double kAny = 1e15;  // holds against every force
  if (!tool.grip) return 0;
  return tool.grip->strength > 0 ? tool.grip->strength : kAny;
}

double tool_grip(const ContactTool& tool, const RunState& state, double time) {
  if (!tool.grip) return 0;
  const auto told = state.gripping.find(tool.name);
  const bool on = told != state.gripping.end()
                      ? told->second
                      : std::any_of(tool.grip->times.begin(), tool.grip->times.end(),
                                    [&](const std::array<double, 2>& t) { return t[0] <= time && time < t[1]; });
  return on ? grip_strength(tool) : 0;
}

ToolForm present_form(const ContactTool& tool, const std::map<std::string, GivenSurfaces>& given) {
  const auto found = given.find(tool.name);
  if (found == given.end()) return tool_form(tool);
  GivenSurfaces surfaces = found->second;
  return tool_form(tool, surfaces);
}

void check_grip(const ContactTool& tool) {
  if (tool.grip) return;
  throw Error(ErrorCode::usage, fmt::format("tool \"{}\" has no \"grip\", so it cannot hold tissue", tool.name));
}

void check_takes_surfaces(const ContactTool& tool) {
  if (tool.shape == ToolShape::mesh && !tool.edges) return;
  throw Error(ErrorCode::usage, fmt::format("tool \"{}\" {}, expected a tool whose shape is a mesh{}", tool.name,
                                            tool.edges ? "has edges" : "is no mesh", tool.edges ? " without edges" : ""));
}

std::shared_ptr<Model> model_with_tools(const Scene& scene, const Model& model, const std::vector<ContactTool>& before,
                                        const std::vector<ContactTool>& next, const std::map<std::string, GivenSurfaces>& given,
                                        const std::vector<const ToolForm*>& known) {
  auto forms = std::make_shared<ToolForms>();
  for (std::size_t t = 0; t < next.size(); ++t) {
    const auto same = std::find(before.begin(), before.end(), next[t]);
    const ToolForm* form = t < known.size() ? known[t] : nullptr;
    if (form == nullptr && same != before.end() && !given.contains(next[t].name)) {
      form = &(*model.tools)[static_cast<std::size_t>(same - before.begin())];
      if (!form->times.empty()) form = nullptr;  // it is to have its file's shape again
    }
    forms->push_back(form != nullptr ? *form : present_form(next[t], given));
  }
  auto out = std::make_shared<Model>(model);
  out->tools = nullptr;
  out->contact_laws.clear();
  Scene with = scene;
  with.tools = next;
  if (next.empty() && !scene.contact) {
    out->contact = nullptr;
    return out;
  }
  out->tools = std::move(forms);
  add_contact(with, *out);
  return out;
}

}  // namespace pliant
