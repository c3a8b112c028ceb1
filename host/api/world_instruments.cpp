// Instruments of a World: tools that devices drive (pliant/haptics.h).
#include <fmt/format.h>

#include <algorithm>

#include "api/world_call.h"

namespace pliant {

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
  const std::vector<ToolForce> tools = rigid_tools.forces();
  const auto own = std::find_if(tools.begin(), tools.end(), [&](const ToolForce& t) { return t.name == name; });
  if (own == tools.end()) {
    std::string all;
    for (const ToolForce& t : tools) all += (all.empty() ? "\"" : ", \"") + t.name + "\"";
    throw Error(ErrorCode::usage,
                fmt::format("haptics: there is no tool \"{}\"; {}", name, all.empty() ? "there are none" : "there are " + all));
  }
  if (own->parked) throw Error(ErrorCode::usage, fmt::format("haptics: tool \"{}\" is parked; unpark it first", name));
  const std::lock_guard lock(mutex);
  for (const auto& other : instruments) {
    if (other->tool() == name && !other->closed.load())
      throw Error(ErrorCode::usage, fmt::format("haptics: another device drives tool \"{}\" already", name));
  }
  instruments.push_back(std::move(instrument));
  return {own->position, own->turn};
}

Pose WorldAccess::attach(World& world, std::shared_ptr<haptics::Instrument> instrument) {
  const api::Call call(world.impl_, false);
  return world.impl_->attach(std::move(instrument));
}

}  // namespace pliant
