#include "cpu_ref/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "backends/interface/pass_table.h"
#include "pliant/error.h"

// One row per kernel: each cpu_ref/<stem>.cpp ends with `void register_<stem>(Registry&)`, which names its instantiations.
// clang-format off
#define PLIANT_TWINS(ROW) \
  ROW(probe) \
  ROW(contact_near) \
  ROW(contact_press) \
  ROW(contact_settle) \
  ROW(contact_tool_sum) \
  ROW(contact_apply) \
  ROW(blade_press) \
  ROW(blade_apply) \
  ROW(touch_box) \
  ROW(touch_tree) \
  ROW(touch_pair) \
  ROW(touch_share) \
  ROW(touch_place) \
  ROW(touch_press) \
  ROW(touch_settle) \
  ROW(tled_tet4_force) \
  ROW(tled_tet4_dilation) \
  ROW(anp_node_pressure) \
  ROW(tled_hex8_force) \
  ROW(tled_hex8full_force) \
  ROW(tled_hex8_brick_force) \
  ROW(membrane_force) \
  ROW(node_update) \
  ROW(brick_update) \
  ROW(node_prescribe) \
  ROW(node_rotate) \
  ROW(node_load) \
  ROW(step_gravity) \
  ROW(link_points) \
  ROW(spring_node) \
  ROW(spring_force) \
  ROW(link_gather) \
  ROW(surface_position) \
  ROW(pressure_force) \
  ROW(fault_reduce) \
  ROW(increment_reduce) \
  ROW(limit_triad) \
  ROW(limit_fma) \
  ROW(flsm_bar) \
  ROW(flsm_plate) \
  ROW(flsm_region) \
  ROW(flsm_goal_plate) \
  ROW(flsm_goal_bar) \
  ROW(flsm_goal) \
  ROW(flsm_update) \
  ROW(flsm_interface) \
  ROW(flsm_damp_region) \
  ROW(flsm_damp_update) \
  ROW(flsm_excess)
// clang-format on

namespace pliant::ref {

#define PLIANT_DECLARE(stem) void register_##stem(Registry&);
PLIANT_TWINS(PLIANT_DECLARE)
#undef PLIANT_DECLARE

const Registry& registry() {
  static const Registry all = [] {
    Registry r;
#define PLIANT_REGISTER(stem) register_##stem(r);
    PLIANT_TWINS(PLIANT_REGISTER)
#undef PLIANT_REGISTER
    return r;
  }();
  return all;
}

Twin Registry::find(const std::string& stem, const Defines& defines) const {
  const auto found = factories_.find(stem);
  if (found == factories_.end()) {
    throw Error(ErrorCode::internal,
                fmt::format("kernel \"{}\" has no twin in cpu_ref; there are: {}", stem, fmt::join(stems(), ", ")));
  }
  return found->second(defines);
}

std::vector<std::string> Registry::stems() const {
  std::vector<std::string> result;
  for (const auto& [stem, factory] : factories_) result.push_back(stem);
  return result;
}

void Registry::require_names(const std::string& stem, const Defines& defines, const std::vector<std::string>& names) {
  for (const auto& [name, value] : defines) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(ErrorCode::internal,
                  fmt::format("the twin of kernel \"{}\" knows no define {} (received {}); it knows: {}", stem, name,
                              defines_text(defines), names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    }
  }
}

int Registry::require_value(const std::string& stem, const Defines& defines, const char* name, int count) {
  const auto found = std::find_if(defines.begin(), defines.end(), [&](const auto& d) { return d.first == name; });
  if (found == defines.end()) {
    throw Error(ErrorCode::internal,
                fmt::format("the twin of kernel \"{}\" needs the define {}, received: {}", stem, name, defines_text(defines)));
  }
  if (found->second < 0 || found->second >= count) {
    throw Error(ErrorCode::internal, fmt::format("the twin of kernel \"{}\" has no {}={}; allowed are 0 to {}", stem, name,
                                                 found->second, count - 1));
  }
  return found->second;
}

}  // namespace pliant::ref
