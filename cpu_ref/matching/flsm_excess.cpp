// Twin of kernels/matching/flsm_excess.cl.
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void flsm_excess(Range range, const Scalar* node_u, const std::int32_t* flsm_slot, const Scalar* flsm_reference,
                 const Scalar* flsm_goals, const Scalar* flsm_beta, const Scalar* flsm_alpha, const Scalar* step_params,
                 Scalar* flsm_excess, std::int32_t batch, std::int32_t substeps, std::int32_t region_base) {
  const Scalar h = Scalar(substeps) * step_params[0], hh = h * h;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int64_t slot = flsm_slot[region_base + i];
    const Scalar* u = node_u + 4 * slot;
    const Scalar share = std::fma(flsm_beta[i] * u[3], hh, -flsm_alpha[batch]);
    for (int c = 0; c < 3; ++c) flsm_excess[4 * slot + c] = share * (flsm_goals[8 * i + c] - (u[c] - flsm_reference[c]));
    flsm_excess[4 * slot + 3] = Scalar(0);
  }
}

void register_flsm_excess(Registry& registry) { registry.add("flsm_excess", flsm_excess<float>, flsm_excess<double>); }

}  // namespace pliant::ref
