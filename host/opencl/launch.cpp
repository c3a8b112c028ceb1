#include "opencl/launch.h"

#include <algorithm>

namespace pliant::opencl {

std::vector<Launch> plan_launches(const Pass& pass, const LaunchRules& rules) {
  if (pass.count == 0) return {};
  const auto count = static_cast<std::size_t>(pass.count);
  if (pass.shape == Shape::bricks && rules.lanes == 1) return {{0, 16 * count, 16}};
  const std::size_t global = pass.shape == Shape::lanes ? count / static_cast<std::size_t>(rules.lanes) : count;
  const auto forced = static_cast<std::size_t>(rules.forced_local);
  if (forced != 0 && global % forced == 0 && forced <= rules.largest) return {{0, global, forced}};
  return {{0, global, 0}};
}

}  // namespace pliant::opencl
