// Twin of kernels/matching/flsm_goal_bar.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_goal_bar(Range range, const Scalar* flsm_plates, const std::int32_t* flsm_link, Scalar* flsm_bars) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar sum[8], moment[4];
    sum_links<Width, 8, PLIANT_FLSM_RECORD, 8, true>(flsm_plates, flsm_link, i, sum, moment);
    for (int k = 0; k < 4; ++k) {
      flsm_bars[8 * i + k] = sum[k] + moment[k];
      flsm_bars[8 * i + 4 + k] = sum[4 + k];
    }
  }
}

void register_flsm_goal_bar(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_goal_bar", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_goal_bar<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
