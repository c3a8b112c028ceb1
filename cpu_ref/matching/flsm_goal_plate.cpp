// Twin of kernels/matching/flsm_goal_plate.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_goal_plate(Range range, const Scalar* flsm_regions, const std::int32_t* flsm_link, Scalar* flsm_plates) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar sum[12], moment[4];
    sum_links<Width, 12, PLIANT_FLSM_RECORD, 12, true>(flsm_regions, flsm_link, i, sum, moment);
    Scalar* out = flsm_plates + PLIANT_FLSM_RECORD * i;
    for (int k = 0; k < 4; ++k) out[k] = sum[k] + moment[k];
    for (int k = 4; k < 12; ++k) out[k] = sum[k];
    for (int k = 12; k < 16; ++k) out[k] = Scalar(0);
  }
}

void register_flsm_goal_plate(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_goal_plate", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_goal_plate<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
