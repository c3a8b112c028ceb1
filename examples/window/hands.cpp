#include "hands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace window {

Hands::Hands(pliant::World& world, const std::vector<std::string>& devices, std::vector<std::string> tools)
    : tools_(std::move(tools)) {
  std::vector<std::string> all;
  for (const pliant::ToolForce& t : world.tool_forces()) all.push_back(t.name);
  const bool only = all.size() == 1;
  for (const pliant::BladeForce& b : world.blade_forces()) all.push_back(b.name);
  if (tools_.empty() && devices.size() == 1 && (only || all.size() == 1)) tools_ = {all[0]};
  if (tools_.size() != devices.size()) {
    std::string names;
    for (const std::string& name : all) names += (names.empty() ? "" : ", ") + name;
    throw std::runtime_error("got " + std::to_string(devices.size()) + " --live and " + std::to_string(tools_.size()) +
                             " --tool, expected a tool or a blade by force for each device; the scene has " +
                             (names.empty() ? "none" : names));
  }
  for (std::size_t i = 0; i < devices.size(); ++i)
    loops_.push_back(std::make_unique<pliant::HapticLoop>(world, tools_[i], pliant::open_haptic_device(devices[i])));
}

double Hands::passed(double most) {
  const auto now = std::chrono::steady_clock::now(), before = std::exchange(last_, now);
  return before == std::chrono::steady_clock::time_point{}
             ? 0
             : std::min(std::chrono::duration<double>(now - before).count(), most);
}

std::vector<std::string> Hands::lines() const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const pliant::HapticState now = loops_[i]->state();
    const pliant::Vec3d& f = now.last.force;
    char text[160];
    std::snprintf(text, sizeof text, "%s: the hand feels %.3g N (%s, %lld ticks)", tools_[i].c_str(),
                  std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]), now.model.c_str(), static_cast<long long>(now.ticks));
    out.emplace_back(text);
  }
  return out;
}

}  // namespace window
