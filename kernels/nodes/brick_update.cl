// node_update for the nodes of lattice bricks. A node sums the forces of its own brick, then, if it lies on a shared face, edge or corner, those of
// the bricks at -x, -y, -xy, -z, -xz, -yz, -xyz. Arguments as in node_update and tled_hex8_brick_force; brick nodes come first in node_u.
#include "arith.cl"
#include "texels.cl"
#include "integrate.cl"

__kernel void brick_update(__global float* node_u, __global float* node_w, __global const int* brick_neighbor,
                           __global const int* brick_rows, __global const float* brick_force, __global const float* node_load, __global float* node_force,
                           __global const float* step_params) {
  const int i = FIRST_INDEX;
  const int brick = i / PLIANT_BRICK_NODES, x = i % 16, y = i / 16 % 4, z = i / 64 % 4;
  if (!(brick_rows[2 * brick + 1] >> (4 * z + y) & 1)) return;
  __global const int* neighbor = brick_neighbor + brick * PLIANT_BRICK_NEIGHBORS + 8;
  real fx = -0.0f, fy = -0.0f, fz = -0.0f;
  for (int side = 0; side < 8; side += 2) {  // own, -y, -z, -yz; each with its -x neighbour
    const int below_y = side & 2, below_z = side & 4;
    if ((below_y && y > 0) || (below_z && z > 0)) continue;
    const int row = (below_z ? 4 : z) * 5 + (below_y ? 4 : y);
    __global const float* own = brick_force + neighbor[side] * PLIANT_BRICK_FORCE + 3 * row * 16 + x;
    __global const float* left = brick_force + neighbor[side + 1] * PLIANT_BRICK_FORCE + PLIANT_BRICK_FORCE_X16 + 3 * row;
    fx += LOAD(own, 0);
    fy += LOAD(own, 16);
    fz += LOAD(own, 32);
#if LANES == 16
    fx.s0 += left[0];
    fy.s0 += left[1];
    fz.s0 += left[2];
#else
    if (x == 0) {
      fx += left[0];
      fy += left[1];
      fz += left[2];
    }
#endif
  }
  integrate(fx, fy, fz, node_u, node_w, node_load, node_force, step_params, i);
}
