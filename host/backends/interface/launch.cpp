#include "backends/interface/launch.h"

#include <algorithm>

namespace pliant {
namespace {

/// What to aim for. Measured on PoCL 3.1, two threads: a launch costs 1.3 us, a work-group 3.5 ns, and a local size left to the
/// driver up to 12 us, for PoCL searches a divisor at each launch; each new local size of a kernel costs a compilation.
/// Explicit lanes gain nothing from large groups and small ones balance better; scalar kernels are vectorised across the group.
/// The figures for GPUs are not measured: whole warps, and enough of them per group to keep a multiprocessor full.
struct Aim {
  std::size_t local;        ///< preferred work-group size, a power of two
  std::size_t most_groups;  ///< more groups of a smaller size cost more than a second launch
};

Aim aim_for(const Pass& pass, const LaunchRules& rules) {
  Aim aim = !rules.cpu ? Aim{128, 2048} : pass.shape == Shape::lanes && rules.lanes == 16 ? Aim{16, 400} : Aim{64, 400};
  while (aim.local > rules.largest) aim.local /= 2;
  return aim;
}

/// Sixteen work-items per brick. On a GPU groups of four bricks fill two warps, and the bricks that remain are groups of one.
std::vector<Launch> brick_rows(std::size_t count, const LaunchRules& rules) {
  const std::size_t together = rules.cpu || rules.largest < 64 ? 1 : 4, rest = count % together;
  std::vector<Launch> launches;
  if (count > rest) launches.push_back({0, 16 * (count - rest), 16 * together});
  if (rest > 0) launches.push_back({16 * (count - rest), 16 * rest, 16});
  return launches;
}

}  // namespace

std::vector<Launch> plan_launches(const Pass& pass, const LaunchRules& rules) {
  if (pass.count == 0) return {};
  const auto count = static_cast<std::size_t>(pass.count);
  if (pass.shape == Shape::bricks && rules.lanes == 1) return brick_rows(count, rules);
  const std::size_t global = pass.shape == Shape::lanes ? count / static_cast<std::size_t>(rules.lanes) : count;
  const auto forced = static_cast<std::size_t>(std::max(rules.forced_local, 0));
  if (forced != 0 && global % forced == 0 && forced <= rules.largest) return {{0, global, forced}};
  if (pass.shape == Shape::bricks) return {{0, global, 1}};  // a brick is work enough for a group
  const Aim aim = aim_for(pass, rules);
  // A CPU's kernels are compiled for each local size, and a cut or a tear changes the count: one size where groups are few, two
  // where they are many.
  const bool few = rules.cpu && pass.shape == Shape::lanes && global <= aim.most_groups;
  if (!few && global % aim.local == 0) return {{0, global, aim.local}};
  std::size_t local = rules.cpu ? 1 : aim.local;
  while (global % local != 0) local /= 2;
  if (global / local <= aim.most_groups) return {{0, global, local}};
  const std::size_t rest = global % aim.local;
  return {{0, global - rest, aim.local}, {global - rest, rest, rules.cpu ? 1 : rest}};
}

Launch plan_listed(std::int64_t indices, const LaunchRules& rules) {
  // The length of lists changes with every search, so use a single local size, for which the kernel is compiled once.
  const std::size_t global = static_cast<std::size_t>(indices) / static_cast<std::size_t>(rules.lanes);
  const std::size_t local =
      rules.cpu ? static_cast<std::size_t>(16 / rules.lanes) : std::min<std::size_t>(64, rules.largest / 16 * 16);
  return {0, (global + local - 1) / local * local, local};
}

}  // namespace pliant
