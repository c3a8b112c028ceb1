// Twin of kernels/flsm_bar.cl.
#include "flsm.h"
#include "registry.h"

namespace pliant::ref {

template <class Scalar, int Width>
void flsm_bar(Range range, const Scalar* node_u, const std::int32_t* flsm_slot, const Scalar* flsm_weight,
              const std::int32_t* flsm_link, Scalar* flsm_bars) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar sum[4], moment[4] = {};
    const Scalar* u = node_u + std::int64_t{4} * flsm_slot[i];
    for (int k = 0; k < 4; ++k) sum[k] = std::fma(flsm_weight[i], u[k], Scalar(0));
    std::int64_t below = i, above = i;
    for (int o = 1; o <= Width; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const Scalar *u_below = node_u + std::int64_t{4} * flsm_slot[below],
                   *u_above = node_u + std::int64_t{4} * flsm_slot[above];
      const Scalar m_below = flsm_weight[below], m_above = flsm_weight[above];
      for (int k = 0; k < 4; ++k) {
        sum[k] = std::fma(m_above, u_above[k], std::fma(m_below, u_below[k], sum[k]));
        moment[k] = std::fma(Scalar(o) * m_above, u_above[k], std::fma(-(Scalar(o) * m_below), u_below[k], moment[k]));
      }
    }
    for (int k = 0; k < 4; ++k) {
      flsm_bars[8 * i + k] = sum[k];
      flsm_bars[8 * i + 4 + k] = moment[k];
    }
  }
}

void register_flsm_bar(Registry& registry) {
  registry.add_specialised<flsm_widths>("flsm_bar", {"WIDTH"},
                                        [](auto scalar, auto width) { return flsm_bar<decltype(scalar), width()>; });
}

}  // namespace pliant::ref
