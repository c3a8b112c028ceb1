// Rigid tools of a World: changes take effect at once if the caller steps, otherwise before the worker's next batch.
#include <fmt/format.h>

#include <algorithm>

#include "api/first_refusal.h"
#include "api/world_call.h"
#include "model/contact/tool_mesh.h"
#include "model/matching/matching_step.h"
#include "scene/tool_entry.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/measure/tool_shapes.h"

namespace pliant {
namespace {

using api::Call;

}  // namespace

void World::Impl::change_tools_now() {
  api::FirstRefusal refusal;
  std::vector<api::RigidTools::Slowed> slowed;
  refusal.attempt([&] { rigid_tools.apply(*simulation, is_live() ? &slowed : nullptr); });
  for (const auto& tool : slowed) {
    const std::string text = fmt::format("tool '{}' is driven in {:.3g} s in place of {:.3g} s: tissue is in its way",
                                         tool.name, tool.seconds, tool.asked);
    events.add(*simulation, api::event_of("slowed", tool.name, tool.seconds, text));
  }
  refusal.attempt([&] { force_blades.apply(*simulation); });
  try {
    refusal.rethrow();
  } catch (const Error& error) {
    throw api::Refused(error, rigid_tools.refused());
  }
}

void World::Impl::check_can_change_tools() {
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return !replacing; });  // by a load() or reset() of a freely running World
    if (job || pace.running()) return;
  }
  throw_failure();
  check_can_step();
}

std::string World::Impl::add_tool(ContactTool tool) {
  Scene as_built = scene;
  take_substeps(*model, as_built);
  check_takes_tools(as_built);
  check_can_change_tools();
  const std::string name = rigid_tools.add(std::move(tool));
  settle_tools();
  return name;
}

void World::Impl::settle_tools() {
  {
    const std::lock_guard lock(mutex);
    if (job || beside || report.diverged || !lost.empty()) return;
  }
  try {
    change_tools_now();
  } catch (const api::Refused& refused) {
    throw Error(refused.code(), refused.what());
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
}

std::string World::add_tool(const ToolSpec& tool) {
  const Call call(impl_, false);
  return impl_->add_tool(tool_of(tool));
}

std::string World::parse_tool(const std::string& text, const std::string& folder) {
  const Call call(impl_, false);
  return impl_->add_tool(pliant::parse_tool(text, folder));
}

void World::remove_tool(const std::string& name) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  impl_->rigid_tools.remove(name);
  impl_->settle_tools();
}

void World::park_tool(const std::string& name) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  impl_->rigid_tools.park(name);
  impl_->settle_tools();
}

void World::unpark_tool(const std::string& name) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  impl_->rigid_tools.unpark(name);
  impl_->settle_tools();
}

void World::grip_tool(const std::string& name, bool on) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  impl_->rigid_tools.grip(name, on);
  impl_->settle_tools();
}

void World::place_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  impl_->rigid_tools.place(name, {position, turn});
  impl_->settle_tools();
}

void World::drive_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn, double seconds) {
  const Call call(impl_, false);
  impl_->rigid_tools.drive(name, {position, turn}, seconds);
  impl_->settle_tools();
}

void World::set_tool_mesh(const std::string& name, const SurfaceSpec& surface, double time) {
  const Call call(impl_, false);
  impl_->check_can_change_tools();
  {
    const std::lock_guard lock(impl_->mutex);
    if (!impl_->job && !impl_->pace.running() && !(time > impl_->report.time)) {
      throw Error(ErrorCode::usage, fmt::format("tool \"{}\": a surface for {} s at {} s, expected a time to come", name, time,
                                                impl_->report.time));
    }
  }
  impl_->rigid_tools.set_mesh(name, {surface.vertices, surface.triangles}, time);
  impl_->settle_tools();
}

std::vector<ToolForce> World::tool_forces() const {
  const Call call(impl_, false);
  return impl_->rigid_tools.forces();
}

SurfaceSpec World::tool_surface(const std::string& name) const {
  const Call call(impl_);
  Simulation& simulation = *impl_->simulation;
  const ContactTool& tool = simulation.tools().known(name);
  const std::vector<ContactTool>& present = simulation.contact().tools();
  const auto found = std::find_if(present.begin(), present.end(), [&](const ContactTool& t) { return t.name == name; });
  TriangleMesh mesh;
  if (tool.shape == ToolShape::half_space) {
    vec::Box all;
    for (const ModelBody& body : simulation.model().bodies) {
      for (const Vec3d& x : body.rest) all.extend(x);
    }
    mesh = plane_around(tool_form(tool), tool_pose(tool, simulation.state(), simulation.time()), all);
  } else if (found != present.end()) {
    mesh = impl_->tool_shapes.own(simulation, static_cast<std::size_t>(found - present.begin()));
  } else {
    const ToolForm parked = present_form(tool, simulation.state().tools.given);
    mesh = shape_at(parked, tool_mesh(parked, kToolSides), simulation.time());
  }
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

}  // namespace pliant
