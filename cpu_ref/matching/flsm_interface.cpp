// Twin of kernels/matching/flsm_interface.cl.
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, bool Extrapolated>
void flsm_interface(Range range, const Scalar* node_u, Scalar* node_load, const std::int32_t* flsm_slot,
                    const Scalar* flsm_reference, const Scalar* flsm_goals, const Scalar* flsm_beta, const Scalar* step_params,
                    std::int32_t substeps, std::int32_t region_base, std::int32_t step) {
  const std::int32_t phase = Extrapolated ? (static_cast<std::int32_t>(step_params[6]) + step) % substeps : 0;
  const Scalar ahead = Scalar(phase) / Scalar(substeps);
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int64_t slot = flsm_slot[region_base + i];
    for (int c = 0; c < 3; ++c) {
      const Scalar now = flsm_goals[8 * i + c];
      const Scalar goal = Extrapolated ? std::fma(ahead, now - flsm_goals[8 * i + 4 + c], now) : now;
      node_load[4 * slot + c] =
          std::fma(flsm_beta[i], goal - (node_u[4 * slot + c] - flsm_reference[c]), node_load[4 * slot + c]);
    }
    node_load[4 * slot + 3] = Scalar(0);
  }
}

void register_flsm_interface(Registry& registry) {
  registry.add_specialised<2>("flsm_interface", {"EXTRAPOLATED"}, [](auto scalar, auto extrapolated) {
    return flsm_interface<decltype(scalar), extrapolated() != 0>;
  });
}

}  // namespace pliant::ref
