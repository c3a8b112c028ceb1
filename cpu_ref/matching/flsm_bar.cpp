// Twin of kernels/matching/flsm_bar.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width, bool Relative>
void flsm_bar(Range range, const Scalar* node_u, const std::int32_t* flsm_slot, const Scalar* flsm_weight,
              const std::int32_t* flsm_link, Scalar* flsm_reference, Scalar* flsm_bars) {
  Scalar origin[4] = {};
  for (int k = 0; Relative && k < 4; ++k) {
    origin[k] = node_u[std::int64_t{4} * flsm_slot[0] + k];
    if (range.begin > 0) continue;
    flsm_reference[4 + k] = flsm_reference[k];
    flsm_reference[k] = origin[k];
  }
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar sum[4], moment[4] = {};
    const Scalar* u = node_u + std::int64_t{4} * flsm_slot[i];
    for (int k = 0; k < 4; ++k) sum[k] = std::fma(flsm_weight[i], u[k] - origin[k], Scalar(0));
    std::int64_t below = i, above = i;
    for (int o = 1; o <= Width; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const Scalar *u_below = node_u + std::int64_t{4} * flsm_slot[below],
                   *u_above = node_u + std::int64_t{4} * flsm_slot[above];
      const Scalar m_below = flsm_weight[below], m_above = flsm_weight[above];
      for (int k = 0; k < 4; ++k) {
        const Scalar below_k = u_below[k] - origin[k], above_k = u_above[k] - origin[k];
        sum[k] = std::fma(m_above, above_k, std::fma(m_below, below_k, sum[k]));
        moment[k] = std::fma(Scalar(o) * m_above, above_k, std::fma(-(Scalar(o) * m_below), below_k, moment[k]));
      }
    }
    for (int k = 0; k < 4; ++k) {
      flsm_bars[8 * i + k] = sum[k];
      flsm_bars[8 * i + 4 + k] = moment[k];
    }
  }
}

void register_flsm_bar(Registry& registry) {
  registry.add_specialised<flsm_widths, 2>("flsm_bar", {"WIDTH", "RELATIVE"}, [](auto scalar, auto width, auto relative) {
    return flsm_bar<decltype(scalar), width(), relative() != 0>;
  });
}

}  // namespace pliant::ref
