#include "api/rigid_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "api/first_refusal.h"
#include "pliant/error.h"
#include "simulation/contact/tool_changes.h"

namespace pliant::api {
namespace {

constexpr int kDoublings = 8;  ///< of the time that a tool may take through tissue

}  // namespace

const ContactTool* RigidTools::find(const std::string& name) const {
  const auto own = tools_.find(name);
  const ContactTool* found = own == tools_.end() ? nullptr : &own->second;
  for (const std::vector<Request>* list : {&std::as_const(doing_), &asked_.all()}) {
    for (const Request& r : *list) {
      if (r.name == name && (r.what == What::add || r.what == What::remove)) found = r.what == What::add ? &r.tool : nullptr;
    }
  }
  return found;
}

void RigidTools::check_known(const std::string& name) const {
  if (knows(name)) return;
  std::set<std::string> known;
  for (const auto& [other, tool] : tools_) known.insert(other);
  for (const Request& r : doing_) known.insert(r.name);
  for (const Request& r : asked_.all()) known.insert(r.name);
  std::string all;
  for (const std::string& other : known) {
    if (knows(other)) all += (all.empty() ? "\"" : ", \"") + other + "\"";
  }
  throw Error(ErrorCode::usage,
              fmt::format("there is no tool \"{}\"; {}", name, all.empty() ? "there are none" : "there are " + all));
}

std::string RigidTools::add(ContactTool tool) {
  auto form = std::make_shared<const ToolForm>(tool_form(tool));
  const std::lock_guard lock(mutex_);
  for (int i = 0; tool.name.empty(); ++i) {
    if (!knows(fmt::format("tool{}", i))) tool.name = fmt::format("tool{}", i);
  }
  if (knows(tool.name)) {
    throw Error(ErrorCode::usage,
                fmt::format("there is a tool \"{}\" already, expected a different name for every tool", tool.name));
  }
  const std::string name = tool.name;
  asked_.push({What::add, name, std::move(tool), std::move(form), {}, 0});
  return name;
}

/// Of several pending drives of a tool only the last one is kept.
void RigidTools::ask(Request request) {
  const std::lock_guard lock(mutex_);
  check_known(request.name);
  Request* const last = asked_.newest([&](const Request& r) { return r.name == request.name; });
  if (request.what == What::drive && last != nullptr && last->what == What::drive) {
    *last = std::move(request);
  } else {
    asked_.push(std::move(request));
  }
}

void RigidTools::remove(const std::string& name) {
  ask({What::remove, name, {}, nullptr, {}, 0});
  const std::lock_guard lock(mutex_);
  given_.erase(name);
}
void RigidTools::park(const std::string& name) { ask({What::park, name, {}, nullptr, {}, 0}); }
void RigidTools::grip(const std::string& name, bool on) {
  {
    const std::lock_guard lock(mutex_);
    check_known(name);
    check_grip(*find(name));
  }
  ask({on ? What::grip : What::let_go, name, {}, nullptr, {}, 0});
}
void RigidTools::unpark(const std::string& name) { ask({What::unpark, name, {}, nullptr, {}, 0}); }

void RigidTools::place(const std::string& name, const Pose& at) {
  check_pose(name, at);
  ask({What::place, name, {}, nullptr, at, 0});
}

void RigidTools::drive(const std::string& name, const Pose& to, double seconds) {
  check_drive(name, to, seconds);
  ask({What::drive, name, {}, nullptr, to, seconds});
}

void RigidTools::set_mesh(const std::string& name, TriangleMesh mesh, double time) {
  ContactTool tool;
  std::shared_ptr<const GivenSurfaces> before;
  {
    const std::lock_guard lock(mutex_);
    check_known(name);
    tool = *find(name);
    if (const auto given = given_.find(name); given != given_.end()) before = given->second;
  }
  check_takes_surfaces(tool);
  auto next = std::make_shared<const GivenSurfaces>(
      next_surface(name, std::move(mesh), time, before != nullptr ? *before : first_surface(tool)));
  const std::lock_guard lock(mutex_);
  given_[name] = next;
  asked_.push({What::mesh, name, {}, nullptr, {}, 0, std::move(next)});
}

void RigidTools::drop_drives() {
  const std::lock_guard lock(mutex_);
  asked_.discard_if([](const Request& r) { return r.what == What::drive; });
}

void RigidTools::hold_back() {
  const std::lock_guard lock(mutex_);
  asked_.hold_back();
}

void RigidTools::go_on() {
  const std::lock_guard lock(mutex_);
  asked_.go_on();
}

void RigidTools::add_save_point() {
  const std::lock_guard lock(mutex_);
  asked_.add_save_point();
}

void RigidTools::remove_save_point() {
  const std::lock_guard lock(mutex_);
  asked_.remove_save_point();
}

std::vector<ToolForce> RigidTools::forces() {
  const std::lock_guard lock(mutex_);
  return forces_;
}

std::vector<ForceSample> RigidTools::trace(const std::string& name, std::int64_t after) {
  const std::lock_guard lock(mutex_);
  const auto blade = blades_.find(name);
  if (blade != blades_.end() && !knows(name)) return blade->second.after(after);
  check_known(name);
  const auto found = traces_.find(name);
  return found == traces_.end() ? std::vector<ForceSample>() : found->second.after(after);
}

/// Where batches were made again, the steps after the state that was kept are others now.
std::int64_t RigidTools::still_valid(const Simulation& simulation) {
  const bool again = std::exchange(made_again_, simulation.report().made_again) != simulation.report().made_again;
  const std::optional<KeptState>& kept = simulation.state().kept;
  return again && kept ? std::min(kept->clock.step, simulation.step()) : simulation.step();
}

void RigidTools::record_blades(const Simulation& simulation, std::int64_t valid) {
  const BladePress& press = simulation.press();
  if (press.names().empty()) return;
  const std::lock_guard lock(mutex_);
  for (auto& [name, trace] : blades_) trace.forget_after(valid);
  const std::vector<Wrench>& forces = press.step_forces();
  const auto steps = static_cast<std::int64_t>(forces.size() / press.names().size());
  for (std::size_t b = 0; b < press.names().size(); ++b) {
    ForceTrace& trace = blades_[press.names()[b]];
    for (std::int64_t s = 0; s < steps && press.batch_end() == simulation.step(); ++s) {
      const Wrench& f = forces[static_cast<std::size_t>(s) * press.names().size() + b];
      const std::int64_t step = simulation.step() - steps + s + 1;
      trace.add({f, step, press.batch_clock().time_at(step)});
    }
  }
}

void RigidTools::record(const Simulation& simulation) {
  const std::int64_t valid = still_valid(simulation);
  record_blades(simulation, valid);
  const ToolContact& contact = simulation.contact();
  const std::vector<ContactTool>& tools = contact.tools();
  if (tools.empty()) return;
  const std::lock_guard lock(mutex_);
  std::erase_if(traces_, [&](const auto& entry) { return !knows(entry.first); });
  for (auto& [name, trace] : traces_) trace.forget_after(valid);
  if (contact.batch_end() != simulation.step()) return;  // the batch was taken back
  const std::vector<Wrench>& forces = contact.step_forces();
  const auto steps = static_cast<std::int64_t>(forces.size() / tools.size());
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (is_face(tools[t])) continue;  // part of its blade
    ForceTrace& trace = traces_[tools[t].name];
    for (std::int64_t s = 0; s < steps; ++s) {
      const Wrench& f = forces[static_cast<std::size_t>(s) * tools.size() + t];
      const std::int64_t step = simulation.step() - steps + s + 1;
      trace.add({f, step, contact.batch_clock().time_at(step)});
    }
  }
}

void RigidTools::make(Simulation& simulation, const Request& request) {
  ToolEdits& tools = simulation.tools();
  switch (request.what) {
    case What::add:
      return tools.add(request.tool, *request.form);
    case What::remove:
      return tools.remove(request.name);
    case What::park:
      return tools.park(request.name);
    case What::grip:
    case What::let_go:
      return tools.grip(request.name, request.what == What::grip);
    case What::unpark:
      return tools.unpark(request.name);
    case What::place:
      return tools.place(request.name, request.to);
    case What::drive:
      return tools.drive(request.name, request.to, request.seconds);
    case What::mesh:
      return tools.set_surface(request.name, *request.surfaces);
  }
}

/// A tool that would be driven through tissue too fast for contact goes there in more time.
void RigidTools::drive_in_time(Simulation& simulation, const Request& request, std::vector<Slowed>& slowed) {
  ToolEdits& tools = simulation.tools();
  try {
    tools.drive(request.name, request.to, request.seconds);
    slow_.erase(request.name);
    return;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input || !tools.is_fast(request.name, request.to, request.seconds)) throw;
    double seconds = request.seconds;
    for (int i = 1; i < kDoublings && tools.is_fast(request.name, request.to, seconds); ++i) seconds *= 2;
    if (tools.is_fast(request.name, request.to, seconds)) throw;
    tools.drive(request.name, request.to, seconds);
    if (slow_.insert(request.name).second) slowed.push_back({request.name, request.seconds, seconds});
  }
}

void RigidTools::apply(Simulation& simulation, std::vector<Slowed>* slowed) {
  refused_.clear();
  {
    const std::lock_guard lock(mutex_);
    doing_ = asked_.take();
    if (doing_.empty()) return;
  }
  FirstRefusal refusal;
  for (const Request& request : doing_) {
    const bool slows = slowed != nullptr && request.what == What::drive;
    const auto attempt = [&] { slows ? drive_in_time(simulation, request, *slowed) : make(simulation, request); };
    if (refusal.attempt(attempt)) continue;
    if (refused_.empty()) refused_ = request.name;
    if (request.what == What::mesh) renew_given(simulation, request.name);
  }
  settle(simulation);
  note(simulation);
  refusal.rethrow();
}

/// After a surface was refused, the next one follows what the tool has.
void RigidTools::renew_given(const Simulation& simulation, const std::string& name) {
  const auto& all = simulation.state().tools.given;
  const auto found = all.find(name);
  const std::lock_guard lock(mutex_);
  given_.erase(name);
  if (found != all.end()) given_[name] = std::make_shared<const GivenSurfaces>(found->second);
}

void RigidTools::settle(const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  tools_.clear();
  for (const ContactTool& tool : known_tools(simulation.scene(), simulation.state().tools)) {
    if (!is_face(tool)) tools_[tool.name] = tool;
  }
  doing_.clear();
}

void RigidTools::note(const Simulation& simulation) {
  std::vector<ToolForce> forces;
  const RunState& state = simulation.state();
  const std::vector<ToolHistory>& felt = simulation.report().tools;
  std::size_t present = 0;
  for (const ContactTool& tool : known_tools(simulation.scene(), state.tools)) {
    const Pose at = tool_pose(tool, state, simulation.time());
    ToolForce force{{}, tool.name, at.position, at.turn, 0, 0, is_parked(state.tools, tool.name)};
    if (!force.parked) {
      const ToolLoad& now = felt[present++].now;
      static_cast<Wrench&>(force) = now;
      force.area = now.area;
      force.penetration = now.depth;
    }
    if (!is_face(tool)) forces.push_back(std::move(force));
  }
  const std::lock_guard lock(mutex_);
  forces_ = std::move(forces);
}

void RigidTools::renew(const Simulation& simulation, bool keep_requests) {
  {
    const std::lock_guard lock(mutex_);
    if (!keep_requests) asked_.clear();
    asked_.go_on();
    made_again_ = simulation.report().made_again;
    given_.clear();
    slow_.clear();
    traces_.clear();
    blades_.clear();
    for (const std::string& name : simulation.press().names()) blades_[name] = {};
    for (const auto& [name, given] : simulation.state().tools.given)
      given_[name] = std::make_shared<const GivenSurfaces>(given);
  }
  settle(simulation);
  note(simulation);
}

}  // namespace pliant::api
