// Splits the index space of a pass into work-items and work-groups. These choices do not affect results.
#pragma once
#include <cstddef>
#include <vector>

#include "program/program.h"

namespace pliant {

/// One enqueue.
struct Launch {
  std::size_t offset = 0, global = 0;
  std::size_t local = 1;
};

struct LaunchRules {
  int lanes = 1;            ///< for `lanes` and `bricks` passes
  int forced_local = 0;     ///< used where it divides the global size
  std::size_t largest = 1;  ///< maximum number of work-items per group of this kernel
  bool cpu = false;
};

/// Returns the enqueues of one run of `pass`; none if its count is zero. A `lanes` or `items` pass may be split in two (the
/// second with a global offset), so such kernels may use only get_global_id; `bricks` passes with one lane have whole rows of
/// 16 work-items per group, and are split likewise.
std::vector<Launch> plan_launches(const Pass& pass, const LaunchRules& rules);

/// Returns the enqueue of a pass over a list of `indices` (Pass::active); the last group may extend beyond them, where lists
/// hold -1.
Launch plan_listed(std::int64_t indices, const LaunchRules& rules);

}  // namespace pliant
