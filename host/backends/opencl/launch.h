// How the index space of a pass is cut into work-items and work-groups. No choice made here can change a result.
#pragma once
#include <cstddef>
#include <vector>

#include "backends/opencl/opencl.h"
#include "program/program.h"

namespace pliant::opencl {

/// One enqueue.
struct Launch {
  std::size_t offset = 0, global = 0;
  std::size_t local = 1;
  [[nodiscard]] cl::NDRange offset_range() const { return offset == 0 ? cl::NullRange : cl::NDRange(offset); }
  [[nodiscard]] cl::NDRange local_range() const { return cl::NDRange(local); }
};

struct LaunchRules {
  int lanes = 1;            ///< of `lanes` and `bricks` passes
  int forced_local = 0;     ///< used where it divides the global size
  std::size_t largest = 1;  ///< work-items that a group of this kernel may have
  bool cpu = false;
};

/// The enqueues of one run of `pass`; none if its count is zero. A `lanes` or `items` pass may be cut in two (the second with a
/// global offset), so such kernels ask for get_global_id and for nothing else; `bricks` passes with one lane have groups of 16.
std::vector<Launch> plan_launches(const Pass& pass, const LaunchRules& rules);

/// The enqueue of a pass over a list of `indices` (Pass::active); a last group reaches beyond them, where lists hold -1.
Launch plan_listed(std::int64_t indices, const LaunchRules& rules);

}  // namespace pliant::opencl
