// Twin of kernels/nodes/brick_update.cl.
#include <algorithm>

#include "cpu_ref/nodes/integrate.h"
#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar, UpdateKind Kind>
void brick_update(Range range, Scalar* node_u, Scalar* node_w, const std::int32_t* brick_neighbor,
                  const std::int32_t* brick_rows, const Scalar* brick_force, const Scalar* node_load, Scalar* node_force,
                  const Scalar* step_params) {
  const StepParameters<Scalar> parameters(step_params);
  for (std::int64_t i = range.begin; i < range.end; i += PLIANT_TILE) {  // a row of nodes
    const std::int64_t y = i / 16 % 4, z = i / 64 % 4;
    if ((brick_rows[2 * (i / PLIANT_BRICK_NODES) + 1] >> (4 * z + y) & 1) == 0) continue;
    const std::int32_t* lower = brick_neighbor + i / PLIANT_BRICK_NODES * PLIANT_BRICK_NEIGHBORS + 8;
    Scalar f[3][PLIANT_TILE];
    std::fill_n(&f[0][0], 3 * PLIANT_TILE, Scalar(-0.0));
    // The bricks at 0, -x, -y, -xy, -z, -xz, -yz, -xyz, if this row lies on the shared part. A brick's own nodes end at its
    // planes y = 3 and z = 3 and at x = 15; its forces on the upper neighbours are stored after those. The bricks at -x act on
    // the node at x = 0.
    for (int side = 0; side < 8; side += 2) {
      const bool from_y = (side & 2) != 0, from_z = (side & 4) != 0;
      if ((from_y && y > 0) || (from_z && z > 0)) continue;
      const std::int64_t row = (from_z ? 4 : z) * 5 + (from_y ? 4 : y);
      const Scalar* own = brick_force + std::int64_t{lower[side]} * PLIANT_BRICK_FORCE + 3 * row * PLIANT_TILE;
      const Scalar* left = brick_force + std::int64_t{lower[side + 1]} * PLIANT_BRICK_FORCE + PLIANT_BRICK_FORCE_X16 + 3 * row;
      for (int c = 0; c < 3; ++c) {
        const Scalar first = left[c];
#pragma GCC unroll 1
        for (int x = 0; x < PLIANT_TILE; ++x) {
          f[c][x] = (f[c][x] + own[c * PLIANT_TILE + x]) + (x == 0 ? first : Scalar(-0.0));  // f + -0 is f, whatever its sign
        }
      }
    }
    integrate_row<Kind>(f, node_u, node_w, node_load, node_force, parameters, i);
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
