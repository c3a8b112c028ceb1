// How the index space of a pass is cut into work-items and work-groups. No choice made here can change a result.
#pragma once
#include <cstddef>
#include <vector>

#include "opencl/opencl.h"
#include "solver/program.h"

namespace pliant::opencl {

/// One enqueue.
struct Launch {
  std::size_t offset = 0, global = 0;
  std::size_t local = 0;  ///< 0: the driver's choice
  [[nodiscard]] cl::NDRange offset_range() const { return offset == 0 ? cl::NullRange : cl::NDRange(offset); }
  [[nodiscard]] cl::NDRange local_range() const { return local == 0 ? cl::NullRange : cl::NDRange(local); }
};

struct LaunchRules {
  int lanes = 1;            ///< of `lanes` and `bricks` passes
  int forced_local = 0;     ///< used where it divides the global size
  std::size_t largest = 1;  ///< work-items that a group of this kernel may have
  bool cpu = false;
};

/// The enqueues of one run of `pass`; none if its count is zero.
std::vector<Launch> plan_launches(const Pass& pass, const LaunchRules& rules);

}  // namespace pliant::opencl
