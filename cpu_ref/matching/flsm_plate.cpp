// Twin of kernels/matching/flsm_plate.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_plate(Range range, const Scalar* flsm_bars, const std::int32_t* flsm_link, Scalar* flsm_plates) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar sum[8], moment[4];
    sum_links<Width, 8, 8, 0, false>(flsm_bars, flsm_link, i, sum, moment);
    Scalar* out = flsm_plates + PLIANT_FLSM_RECORD * i;
    for (int k = 0; k < 8; ++k) out[k] = sum[k];
    for (int k = 0; k < 4; ++k) {
      out[8 + k] = moment[k];
      out[12 + k] = Scalar(0);
    }
  }
}

void register_flsm_plate(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_plate", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_plate<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
