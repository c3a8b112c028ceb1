// Twin of kernels/nodes/node_update.cl.
#include "cpu_ref/nodes/integrate.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, UpdateKind Kind>
void node_update(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* gather_offset,
                 const std::int32_t* gather_index, const Scalar* corner_force, const Scalar* node_load, Scalar* node_force,
                 const Scalar* step_params, std::int32_t node_base) {
  const StepParameters<Scalar> parameters(step_params);
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t first = gather_offset[i / PLIANT_TILE], last = gather_offset[i / PLIANT_TILE + 1];
    Scalar f[3] = {Scalar(-0.0), Scalar(-0.0), Scalar(-0.0)};
    for (std::int64_t k = first; k < last; ++k) {
      const Scalar* corner = corner_force + gather_index[k * PLIANT_TILE + i % PLIANT_TILE];
      for (int c = 0; c < 3; ++c) f[c] += corner[c * PLIANT_TILE];
    }
    integrate<Kind>(f, node_u, node_w, node_load, node_force, parameters, node_base + i);
  }
}

void register_node_update(Registry& registry) {
  registry.add_specialised<2, 2, integrator_count>(
      "node_update", {"HAS_LOAD", "FORCE_ONLY", "INTEGRATOR"},
      [](auto scalar, auto has_load, auto force_only, auto integrator) {
        constexpr UpdateKind kind{has_load() != 0, force_only() != 0, integrator()};
        return node_update<decltype(scalar), kind>;
      });
}

}  // namespace pliant::ref
