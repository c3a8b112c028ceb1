// Twin of kernels/matching/flsm_update.cl.
#include <limits>

#include "cpu_ref/matching/flsm.h"
#include "cpu_ref/nodes/integrate.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, int Width, bool HasLoad>
void flsm_update(Range range, Scalar* node_u, Scalar* node_w, const Scalar* node_load, const Scalar* flsm_bars,
                 const std::int32_t* flsm_link, const Scalar* flsm_regions, const std::int32_t* missing_of_offset,
                 const std::int32_t* missing_of, const Scalar* missing_of_factor, const Scalar* flsm_inverse_holders,
                 const Scalar* flsm_reference, const Scalar* step_params, const Scalar* flsm_alpha, std::int32_t* fault,
                 std::int32_t batch, std::int32_t substeps, std::int32_t node_base, std::int32_t fault_base,
                 std::int32_t step) {
  const StepParameters<Scalar> params(step_params);
  const Scalar h = Scalar(substeps) * step_params[0], half_hh = (Scalar(0.5) * h) * h;
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    Scalar goal[4];
    goal_sum<Width>(flsm_bars, flsm_link, flsm_regions, missing_of_offset, missing_of, missing_of_factor, i, goal);
    Scalar *u = node_u + 4 * (node_base + i), *w = node_w + 4 * (node_base + i);
    const Scalar a = w[3], b = std::fma(half_hh, a, half_hh), bm = b * u[3];
    bool finite = true;
    for (int c = 0; c < 3; ++c) {
      const Scalar weight = b * params.gravity[c];
      const Scalar push = HasLoad ? std::fma(bm, node_load[4 * (node_base + i) + c], weight) : weight;
      const Scalar to_goal = std::fma(goal[c], flsm_inverse_holders[i], -(u[c] - flsm_reference[c]));
      const Scalar full = std::fma(flsm_alpha[batch], to_goal, std::fma(a, w[c], push));
      const Scalar next = u[3] > Scalar(0) ? params.increment(full) : Scalar(0);
      w[c] = next;
      u[c] = params.displacement(u[c] + next);
      finite = finite && std::fabs(u[c]) < std::numeric_limits<Scalar>::infinity();
    }
    mark_fault(finite ? 0 : 2, step, fault[fault_base + i]);
  }
}

void register_flsm_update(Registry& registry) {
  registry.add_specialised<flsm_widths, 2>("flsm_update", {"WIDTH", "HAS_LOAD"}, [](auto scalar, auto width, auto has_load) {
    return flsm_update<decltype(scalar), width(), has_load() != 0>;
  });
}

}  // namespace pliant::ref
