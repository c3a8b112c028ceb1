// Random launches of the two update kernels.
#pragma once
#include "integrators/integrator.h"
#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test {

/// A grid of 2 x 2 x 2 bricks; brick 0 is the empty one.
struct BrickGrid {
  static constexpr int bricks = 2, nx = 2 * PLIANT_BRICK_X, ny = 2 * PLIANT_BRICK_Y, nz = 2 * PLIANT_BRICK_Z;
  static constexpr std::size_t slots = 9 * PLIANT_BRICK_NODES;
  static int brick(int x, int y, int z) {
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < bricks && y < bricks && z < bricks;
    return inside ? 1 + x + bricks * (y + bricks * z) : 0;
  }
  /// Where node (or cell) (x, y, z) stands.
  static std::int32_t slot(int x, int y, int z) {
    return brick(x / 16, y / 4, z / 4) * PLIANT_BRICK_NODES + (z % 4 * 4 + y % 4) * 16 + x % 16;
  }
  static Ints neighbors() {
    Ints result(9 * PLIANT_BRICK_NEIGHBORS, 0);
    for (int b = 1; b < 9; ++b) {
      const int x = (b - 1) % 2, y = (b - 1) / 2 % 2, z = (b - 1) / 4;
      for (int mask = 0; mask < 8; ++mask) {
        const int dx = mask & 1, dy = mask >> 1 & 1, dz = mask >> 2 & 1;
        result[static_cast<std::size_t>(b * 16 + mask)] = brick(x + dx, y + dy, z + dz);
        result[static_cast<std::size_t>(b * 16 + 8 + mask)] = brick(x - dx, y - dy, z - dz);
      }
    }
    return result;
  }
};

/// [nodes] texels (u, 1/m): a third of the slots hold no node or a fixed one.
inline Reals node_u_texels(Random& random, std::size_t nodes, Data data) {
  Reals u = random.reals(4 * nodes, data, 0.01);
  if (data == Data::bits) return u;
  for (std::size_t i = 0; i < nodes; ++i) u[4 * i + 3] = random.chance(0.3) ? 0 : random.uniform(10, 1000);
  return u;
}

/// [nodes] texels (w, decay).
inline Reals node_w_texels(Random& random, std::size_t nodes, Data data) {
  Reals w = random.reals(4 * nodes, data, 1e-4);
  if (data == Data::bits) return w;
  for (std::size_t i = 0; i < nodes; ++i) w[4 * i + 3] = random.uniform(0.9, 1);
  return w;
}

/// With every other seed, increments below a floor are none.
inline Reals step_parameters(std::uint32_t seed) {
  return {1e-3, 0.1, -9.81, 0.25, seed % 2 != 0 ? 2e-5 : 0, seed % 3 != 0 ? 0.03125 : 0, 0, 0};
}

inline Defines update_defines(int has_load, int force_only, Integrator integrator = Integrator::increment) {
  return {{"HAS_LOAD", has_load}, {"FORCE_ONLY", force_only}, {"INTEGRATOR", static_cast<int>(integrator)}};
}

/// Gather lists of 0 to 7 rows per tile; short nodes are padded with the position of a -0.
inline KernelCase node_update_case(const Defines& defines, std::size_t nodes, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr std::size_t base = 32, tiles_of_force = 40;  // base: nodes of another batch come first
  Reals force = random.reals(tiles_of_force * 3 * PLIANT_TILE, data, 2);
  const std::size_t padding = force.size();
  force.resize(padding + 3 * PLIANT_TILE, -0.0);
  Ints offset{0}, index;
  for (std::size_t tile = 0; tile < nodes / PLIANT_TILE; ++tile) {
    const int rows = random.integer(0, 7);
    for (int row = 0; row < rows; ++row) {
      for (int lane = 0; lane < PLIANT_TILE; ++lane) {
        const bool used = row <= lane % 8;
        const int position =
            random.integer(0, static_cast<int>(tiles_of_force) - 1) * 3 * PLIANT_TILE + random.integer(0, PLIANT_TILE - 1);
        index.push_back(used ? position : static_cast<int>(padding) + lane);
      }
    }
    offset.push_back(offset.back() + rows);
  }
  index.resize(index.size() + PLIANT_TILE, 0);
  const std::size_t all = nodes + base;
  KernelCase test("node_update", defines, Shape::lanes, nodes);
  test.reals("node_u", node_u_texels(random, all, data))
      .reals("node_w", node_w_texels(random, all, data))
      .ints("gather_offset", std::move(offset))
      .ints("gather_index", std::move(index))
      .reals("corner_force", std::move(force))
      .reals("node_load", random.reals(4 * all, data, 1))
      .reals("node_force", random.reals(4 * all, Data::large, 1))
      .reals("step_params", step_parameters(seed))
      .integer(static_cast<std::int32_t>(base));
  return test;
}

inline KernelCase brick_update_case(const Defines& defines, std::size_t bricks, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t nodes = bricks * PLIANT_BRICK_NODES;
  KernelCase test("brick_update", defines, Shape::lanes, nodes);
  test.reals("node_u", node_u_texels(random, nodes, data))
      .reals("node_w", node_w_texels(random, nodes, data))
      .ints("brick_neighbor", random.ints(bricks * PLIANT_BRICK_NEIGHBORS, 0, static_cast<int>(bricks) - 1))
      .ints("brick_rows", random.ints(2 * bricks, 0, 0xFFFF))
      .reals("brick_force", random.reals(bricks * PLIANT_BRICK_FORCE, data, 2))
      .reals("node_load", random.reals(4 * nodes, data, 1))
      .reals("node_force", random.reals(4 * nodes, Data::large, 1))
      .reals("step_params", step_parameters(seed));
  return test;
}

}  // namespace pliant::kernel_test
