#include "simulation/edits/tool_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "scene/tool_entry.h"
#include "simulation/contact/present_tissue.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/contact/tool_swap.h"

namespace pliant {

/// The new tools and the model with them.
struct ToolEdits::Next {
  ToolChanges changes;
  std::vector<ContactTool> tools;
  std::shared_ptr<const Model> model;
  [[nodiscard]] std::size_t number(const std::string& name) const {
    const auto named = [&](const ContactTool& tool) { return tool.name == name; };
    return static_cast<std::size_t>(std::find_if(tools.begin(), tools.end(), named) - tools.begin());
  }
};

namespace {

void insert(std::vector<std::string>& names, const std::string& name) {
  names.insert(std::lower_bound(names.begin(), names.end(), name), name);
}

/// Returns true if the model has contact points; bodies without a surface have none.
bool touchable(const Model& model) { return model.contact != nullptr && model.contact->size() > 0; }

}  // namespace

const ContactTool& ToolEdits::known(const std::string& name) const {
  const auto named = [&](const ContactTool& tool) { return tool.name == name && !is_face(tool); };
  const auto added = std::find_if(run_.state.tools.added.begin(), run_.state.tools.added.end(), named);
  if (added != run_.state.tools.added.end()) return *added;
  const std::vector<std::string>& removed = run_.state.tools.removed;
  const auto own = std::find_if(run_.scene.tools.begin(), run_.scene.tools.end(), named);
  if (own != run_.scene.tools.end() && std::find(removed.begin(), removed.end(), name) == removed.end()) return *own;
  throw Error(ErrorCode::usage, fmt::format("there is no tool \"{}\"", name));
}

ToolEdits::Next ToolEdits::with(ToolChanges changes, const ContactTool* fresh, const ToolForm* form) const {
  Next next{std::move(changes), {}, nullptr};
  next.tools = present_tools(run_.scene, next.changes);
  if (next.tools.size() > most_tools) {
    throw Error(ErrorCode::bad_input, fmt::format("{} tools that are not parked, expected at most {}: park one or remove it",
                                                  next.tools.size(), most_tools));
  }
  std::vector<const ToolForm*> forms(next.tools.size(), nullptr);
  if (fresh != nullptr) forms[next.number(fresh->name)] = form;
  next.model = model_with_tools(run_.scene, run_.model(), contact_.tools(), next.tools, next.changes.given, forms);
  return next;
}

void ToolEdits::take_up(Next next) {
  load_tools(run_, next.model, contact_.tools(), next.tools);
  run_.state.tools = std::move(next.changes);
  contact_.follow();
}

void ToolEdits::add(const ContactTool& tool, const ToolForm& form) {
  for (const ContactTool& other : known_tools(run_.scene, run_.state.tools)) {
    if (other.name == tool.name) throw Error(ErrorCode::usage, fmt::format("there is a tool \"{}\" already", tool.name));
  }
  check_takes_tools(run_.scene);
  ToolChanges changes = run_.state.tools;
  changes.added.push_back(tool);
  Next next = with(std::move(changes), &tool, &form);
  const double now = run_.state.clock.time();
  if (touchable(*next.model)) PresentTissue(*next.model, run_.u()).refuse_inside(tool.name, form, tool.at(now), now);
  take_up(std::move(next));
}

void ToolEdits::remove(const std::string& name) {
  (void)known(name);
  ToolChanges changes = run_.state.tools;
  std::erase(changes.parked, name);
  if (std::erase_if(changes.added, [&](const ContactTool& tool) { return tool.name == name; }) == 0)
    insert(changes.removed, name);
  changes.given.erase(name);
  if (is_parked(run_.state.tools, name)) {
    run_.state.tools = std::move(changes);
  } else {
    take_up(with(std::move(changes)));
  }
  run_.state.driven.erase(name);
  run_.state.gripping.erase(name);
}

void ToolEdits::park(const std::string& name) {
  (void)known(name);
  if (is_parked(run_.state.tools, name)) return;
  ToolChanges changes = run_.state.tools;
  insert(changes.parked, name);
  take_up(with(std::move(changes)));
}

ToolEdits::Next ToolEdits::unparked(const std::string& name) const {
  ToolChanges changes = run_.state.tools;
  std::erase(changes.parked, name);
  return with(std::move(changes));
}

void ToolEdits::unpark(const std::string& name) {
  const ContactTool& tool = known(name);
  if (!is_parked(run_.state.tools, name)) return;
  Next next = unparked(name);
  const double now = run_.state.clock.time();
  if (touchable(*next.model)) {
    PresentTissue(*next.model, run_.u())
        .refuse_inside(name, (*next.model->tools)[next.number(name)], tool_pose(tool, run_.state, now), now);
  }
  take_up(std::move(next));
}

std::size_t ToolEdits::number(const std::string& name) const {
  const auto named = [&](const ContactTool& tool) { return tool.name == name; };
  return static_cast<std::size_t>(std::find_if(contact_.tools().begin(), contact_.tools().end(), named) -
                                  contact_.tools().begin());
}

void ToolEdits::place(const std::string& name, const Pose& at) {
  (void)known(name);
  check_pose(name, at);
  const bool parked = is_parked(run_.state.tools, name);
  Next next = parked ? unparked(name) : Next{run_.state.tools, contact_.tools(), run_.loaded.shared_model()};
  const ToolForm& form = (*next.model->tools)[next.number(name)];
  if (touchable(*next.model)) PresentTissue(*next.model, run_.u()).refuse_inside(name, form, at, run_.state.clock.time());
  if (parked) {
    take_up(std::move(next));
  } else {
    let_go(run_, number(name));
  }
  contact_.drive(number(name), at, 0);
}

void ToolEdits::set_surface(const std::string& name, const GivenSurfaces& next) {
  const ContactTool tool = known(name);
  check_takes_surfaces(tool);
  ToolChanges changes = run_.state.tools;
  GivenSurfaces first = next;
  first.surfaces.pop_back();
  GivenSurfaces& all = changes.given.try_emplace(name, std::move(first)).first->second;
  append_surface(name, all, next, run_.state.clock.time());
  if (is_parked(changes, name)) {
    run_.state.tools = std::move(changes);
    return;
  }
  const ToolForm form = tool_form(tool, all), &before = (*run_.model().tools)[number(name)];
  run_.state.relaxation.equilibrium = false;  // relaxation restarts
  if (!before.times.empty() && before.grid == form.grid) {
    replace_shape(run_, number(name), form);
    run_.state.tools = std::move(changes);
  } else {
    take_up(with(std::move(changes), &tool, &form));
  }
}

void ToolEdits::grip(const std::string& name, bool on) {
  check_grip(known(name));
  run_.state.gripping[name] = on;
  run_.state.relaxation.equilibrium = false;  // relaxation restarts
}

Pose ToolEdits::within_reach(const std::string& name, const Pose& to, double seconds) const {
  constexpr double kReserve = 0.99;
  const Model& model = run_.model();
  if (!touchable(model)) return to;
  const double now = run_.state.clock.time(), cell = model.contact->spacing;
  const ToolForm& form = (*model.tools)[number(name)];
  const Pose from = tool_pose(known(name), run_.state, now);
  const double share = share_in_time(form, from, to, seconds, cell);
  if (share >= 1 || PresentTissue(model, run_.u()).in_the_way(form, from, to, now).depth == 0) return to;
  return between(from, to, kReserve * share);
}

bool ToolEdits::is_fast(const std::string& name, const Pose& to, double seconds) const {
  const Model& model = run_.model();
  if (!touchable(model)) return false;
  const ContactTool& tool = known(name);
  const Pose from = tool_pose(tool, run_.state, run_.state.clock.time());
  return is_too_fast(present_form(tool, run_.state.tools.given), from, to, seconds, model.contact->spacing);
}

void ToolEdits::drive(const std::string& name, const Pose& to, double seconds) {
  const ContactTool& tool = known(name);
  check_drive(name, to, seconds);
  const bool parked = is_parked(run_.state.tools, name);
  Next next = parked ? unparked(name) : Next{run_.state.tools, contact_.tools(), run_.loaded.shared_model()};
  const ToolForm& form = (*next.model->tools)[next.number(name)];
  const double now = run_.state.clock.time();
  const Pose from = tool_pose(tool, run_.state, now);
  const bool fast = touchable(*next.model) && is_too_fast(form, from, to, seconds, next.model->contact->spacing);
  if (touchable(*next.model) && (parked || fast)) {
    const PresentTissue tissue(*next.model, run_.u());
    if (parked) tissue.refuse_inside(name, form, from, now);
    if (fast) tissue.refuse_in_the_way(name, form, from, to, now, seconds);
  }
  if (parked) take_up(std::move(next));
  contact_.drive(number(name), to, seconds);
}

}  // namespace pliant
