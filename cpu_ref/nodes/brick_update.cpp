// Twin of kernels/nodes/brick_update.cl.
#include "cpu_ref/nodes/integrate.h"
#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar, UpdateKind Kind>
void brick_update(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* brick_neighbor,
                  const std::int32_t* brick_rows, const Scalar* brick_force, const Scalar* node_load, Scalar* node_force,
                  const Scalar* step_params) {
  const StepParameters<Scalar> parameters(step_params);
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int64_t x = i % 16, y = i / 16 % 4, z = i / 64 % 4;
    if ((brick_rows[2 * (i / PLIANT_BRICK_NODES) + 1] >> (4 * z + y) & 1) == 0) continue;
    const std::int32_t* lower = brick_neighbor + i / PLIANT_BRICK_NODES * PLIANT_BRICK_NEIGHBORS + 8;
    Scalar f[3] = {Scalar(-0.0), Scalar(-0.0), Scalar(-0.0)};
    // The bricks at 0, -x, -y, -xy, -z, -xz, -yz, -xyz, if this node lies on the shared part. A brick's own nodes end at its
    // planes y = 3 and z = 3 and at x = 15; its forces on the upper neighbours are stored after those.
    for (int side = 0; side < 8; ++side) {
      const bool from_x = (side & 1) != 0, from_y = (side & 2) != 0, from_z = (side & 4) != 0;
      if ((from_x && x > 0) || (from_y && y > 0) || (from_z && z > 0)) continue;
      const Scalar* force = brick_force + std::int64_t{lower[side]} * PLIANT_BRICK_FORCE;
      const std::int64_t row = (from_z ? 4 : z) * 5 + (from_y ? 4 : y);
      for (int c = 0; c < 3; ++c) f[c] += from_x ? force[PLIANT_BRICK_FORCE_X16 + 3 * row + c] : force[(3 * row + c) * 16 + x];
    }
    integrate<Kind>(f, node_u, node_w, node_load, node_force, parameters, i);
  }
}

void register_brick_update(Registry& registry) {
  registry.add_specialised<2, 2, integrator_count>(
      "brick_update", {"HAS_LOAD", "FORCE_ONLY", "INTEGRATOR"},
      [](auto scalar, auto has_load, auto force_only, auto integrator) {
        constexpr UpdateKind kind{has_load() != 0, force_only() != 0, integrator()};
        return brick_update<decltype(scalar), kind>;
      });
}

}  // namespace pliant::ref
