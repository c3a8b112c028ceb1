// Twin of kernels/matching/flsm_damp_update.cl.
#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Width, bool Reaction>
void flsm_damp_update(Range range, const Scalar* node_u, Scalar* node_w, const std::int32_t* flsm_slot, const Scalar* flsm_bars,
                      const std::int32_t* flsm_link, const Scalar* flsm_rates, const std::int32_t* missing_of_offset,
                      const std::int32_t* missing_of, const Scalar* missing_of_factor, const Scalar* flsm_inverse_holders,
                      Scalar damping, std::int32_t substeps, std::int32_t interface_base) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int64_t slot = flsm_slot[i];
    Scalar rigid[4];
    goal_sum<Width>(flsm_bars, flsm_link, flsm_rates, missing_of_offset, missing_of, missing_of_factor, i, rigid);
    const Scalar share = i < interface_base ? flsm_inverse_holders[i] : flsm_inverse_holders[i] / Scalar(substeps);
    if (!(node_u[4 * slot + 3] > Scalar(0))) continue;
    for (int c = 0; c < 3; ++c) {
      Scalar& w = node_w[4 * slot + c];
      w = Reaction ? std::fma(-rigid[c], share, w) : std::fma(damping, std::fma(rigid[c], share, -w), w);
    }
  }
}

void register_flsm_damp_update(Registry& registry) {
  registry.add_specialised<flsm_widths, 2>(
      "flsm_damp_update", {"WIDTH", "REACTION"},
      [](auto scalar, auto width, auto reaction) { return flsm_damp_update<decltype(scalar), width(), reaction() != 0>; });
}

}  // namespace pliant::ref
