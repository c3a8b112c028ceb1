// Instruments of a World: tools that devices drive (pliant/haptics.h).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "api/world_call.h"
#include "haptics/driven_part.h"

namespace pliant {
namespace {

/// Where the tool or blade of this name is. Throws Error (usage).
Pose place_of(api::RigidTools& tools, const api::ForceBlades& blades, const std::string& name) {
  std::vector<std::string> names;
  for (const ToolForce& t : tools.forces()) {
    if (t.name == name && t.parked)
      throw Error(ErrorCode::usage, fmt::format("haptics: tool \"{}\" is parked; unpark it first", name));
    if (t.name == name) return {t.position, t.turn};
    names.push_back('"' + t.name + '"');
  }
  for (const BladeForce& b : blades.forces()) {
    if (b.name == name && !b.present) {
      throw Error(ErrorCode::usage,
                  fmt::format("haptics: blade \"{}\" is nowhere at present; drive_blade() places it first", name));
    }
    if (b.name == name) return haptics::blade_pose({b.a, b.b});
    names.push_back('"' + b.name + '"');
  }
  throw Error(ErrorCode::usage,
              fmt::format("haptics: there is no tool or blade by force \"{}\"; {}", name,
                          names.empty() ? "there are none" : "there are " + fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

void World::Impl::move_instruments(double seconds) {
  std::vector<std::shared_ptr<haptics::Instrument>> present;
  {
    const std::lock_guard lock(mutex);
    std::erase_if(instruments, [](const auto& i) { return i->closed.load(); });
    present = instruments;
  }
  for (const auto& instrument : present) {
    const std::optional<std::string> refused = instrument->before(*simulation, seconds);
    if (refused && is_live()) events.add(*simulation, api::event_of("refused", instrument->tool(), 0, *refused));
  }
}

void World::Impl::tell_instruments() {
  std::vector<std::shared_ptr<haptics::Instrument>> present;
  {
    const std::lock_guard lock(mutex);
    present = instruments;
  }
  try {
    for (const auto& instrument : present) instrument->after(*simulation);
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
}

StepReport World::Impl::step_frame(std::int64_t steps) {
  move_instruments(static_cast<double>(steps) * simulation->dt());
  StepReport done = run(steps);
  tell_instruments();
  return done;
}

StepReport World::Impl::advance_frame(double seconds) {
  move_instruments(seconds);
  StepReport done = advance(seconds);
  tell_instruments();
  return done;
}

Pose World::Impl::attach(std::shared_ptr<haptics::Instrument> instrument) {
  const std::string& name = instrument->tool();
  const Pose start = place_of(rigid_tools, force_blades, name);
  const std::lock_guard lock(mutex);
  for (const auto& other : instruments) {
    if (other->tool() == name && !other->closed.load())
      throw Error(ErrorCode::usage, fmt::format("haptics: another device drives \"{}\" already", name));
  }
  instruments.push_back(std::move(instrument));
  return start;
}

Pose WorldAccess::attach(World& world, std::shared_ptr<haptics::Instrument> instrument) {
  const api::Call call(world.impl_, false);
  return world.impl_->attach(std::move(instrument));
}

}  // namespace pliant
