// Twin of kernels/matching/flsm_goal.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_goal(Range range, const Scalar* flsm_bars, const std::int32_t* flsm_link, const Scalar* flsm_regions,
               const std::int32_t* missing_of_offset, const std::int32_t* missing_of, const Scalar* missing_of_factor,
               const Scalar* flsm_inverse_holders, const Scalar* flsm_reference, Scalar* flsm_goals, std::int32_t region_base) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar goal[4];
    goal_sum<Width>(flsm_bars, flsm_link, flsm_regions, missing_of_offset, missing_of, missing_of_factor, region_base + i,
                    goal);
    for (int k = 0; k < 4; ++k) {
      flsm_goals[8 * i + 4 + k] = flsm_goals[8 * i + k] + (flsm_reference[4 + k] - flsm_reference[k]);
      flsm_goals[8 * i + k] = goal[k] * flsm_inverse_holders[region_base + i];
    }
  }
}

void register_flsm_goal(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_goal", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_goal<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
