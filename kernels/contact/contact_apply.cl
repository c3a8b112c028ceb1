// Applies the forces of contact points to their nodes immediately: u and w change by b c f / m. Forces are integer quanta and weights integer units,
// so the sum over the nodes equals the sum over the points to the last bit, in any order. contact_slot: [nodes] slots; contact_free: [nodes] bit mask
// of the free components; contact_node_list: tiles of nodes whose points are near something; contact_tiles_offset: [tiles + 1]; contact_tiles: the
// tiles of points at each tile of nodes; contact_gather_offset: [tiles + 1] rows; contact_gather: [rows][16] positions in contact_force;
// contact_gather_units: [rows][16] weights in units; with MOMENT contact_gather_turns: [rows][2][16] gradients along both tangents in units, which sum to
// zero over a point's nodes, for touch_moment (touch_point.cl). With EDGES contact_gather_corner: [rows][16] index of this node within the point, -1:
// none, for contact_corner_force (contact_edge.cl). contact_node_sum: [slots] (force (3) [N], sum of weights times areas of the touching points [m^2]).
#include "arith.cl"

__kernel void contact_apply(__global float* node_u, __global float* node_w, __global const int* contact_slot,
                            __global const int* contact_free, __global const int* contact_node_list,
                            __global const int* contact_tiles_offset, __global const int* contact_tiles,
                            __global const int* contact_gather_offset,
                            __global const int* contact_gather, __global const int* contact_gather_units,
                            __global const int* contact_gather_turns, __global const int* contact_near,
                            __global const int* contact_force, __global const int* touch_moment,
                            __global const int* contact_gather_corner, __global const int* contact_corner_force,
                            __global const float* contact_corner_weight,
                            __global const float* contact_rest, __global float* contact_node_sum,
                            __global const float* contact_params, __global const float* step_params) {
  const int first = FIRST_LISTED(contact_node_list), tile = first / PLIANT_TILE;
  if (first < 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h, quantum = contact_params[2];
  int last_row = contact_gather_offset[tile + 1];
#if LANES > 1
  // Few of the points that are near something touch it. One line of a tile of points costs less than the rows that lead to it.
  int touched = 0;
  for (int t = contact_tiles_offset[tile]; t < contact_tiles_offset[tile + 1]; ++t) {
    const int points = contact_tiles[t];
    if (contact_near[points] == 0) continue;
    __global const int* marks = contact_force + points * (4 * PLIANT_TILE) + 3 * PLIANT_TILE;
    for (int l = 0; l < PLIANT_TILE; ++l) touched |= marks[l];
  }
  if (touched == 0) last_row = contact_gather_offset[tile];
#endif
  for (int i = first; i < first + LANES; ++i) {
    long x = 0, y = 0, z = 0;
    float area = 0.0f;
    for (int k = contact_gather_offset[tile]; k < last_row; ++k) {
      const int entry = k * PLIANT_TILE + i % PLIANT_TILE, units = contact_gather_units[entry], at = contact_gather[entry];
      if ((units == 0 && MOMENT == 0 && EDGES == 0) || contact_near[at / (4 * PLIANT_TILE)] == 0 || contact_force[at + 3 * PLIANT_TILE] == 0) continue;
      x += (long)contact_force[at] * units;
      y += (long)contact_force[at + PLIANT_TILE] * units;
      z += (long)contact_force[at + 2 * PLIANT_TILE] * units;
#if MOMENT
      if ((contact_near[at / (4 * PLIANT_TILE)] & PLIANT_TOUCH_BIT) != 0) {
        __global const int* moment = touch_moment + at / (4 * PLIANT_TILE) * (PLIANT_TOUCH_MOMENT * PLIANT_TILE) + at % PLIANT_TILE;
        const int first_turn = contact_gather_turns[2 * k * PLIANT_TILE + i % PLIANT_TILE];
        const int second_turn = contact_gather_turns[(2 * k + 1) * PLIANT_TILE + i % PLIANT_TILE];
        x += (long)moment[0] * first_turn + (long)moment[3 * PLIANT_TILE] * second_turn;
        y += (long)moment[PLIANT_TILE] * first_turn + (long)moment[4 * PLIANT_TILE] * second_turn;
        z += (long)moment[2 * PLIANT_TILE] * first_turn + (long)moment[5 * PLIANT_TILE] * second_turn;
      }
#endif
      float weight = (float)units * (1.0f / 4096.0f);
#if EDGES
      const int corner = contact_gather_corner[entry];
      if (corner >= 0 && (contact_near[at / (4 * PLIANT_TILE)] & ~PLIANT_TOUCH_BIT) != 0) {
        const int point = at / (4 * PLIANT_TILE), lane = at % PLIANT_TILE;
        __global const int* part = contact_corner_force + point * (24 * PLIANT_TILE) + 3 * corner * PLIANT_TILE + lane;
        __global const float* weights = contact_corner_weight + point * (9 * PLIANT_TILE) + lane;
        x += (long)part[0] * 4096;
        y += (long)part[PLIANT_TILE] * 4096;
        z += (long)part[2 * PLIANT_TILE] * 4096;
        weight = fabs(weights[corner * PLIANT_TILE]) * weights[8 * PLIANT_TILE];
      }
#endif
      area = fma(weight, contact_rest[at + 3 * PLIANT_TILE], area);
    }
    const int slot = contact_slot[i], free = contact_free[i];
    const float fx = (float)x * quantum, fy = (float)y * quantum, fz = (float)z * quantum;
    __global float* u = node_u + 4 * slot;
    __global float* w = node_w + 4 * slot;
    __global float* sum = contact_node_sum + 4 * slot;
    sum[0] = fx;
    sum[1] = fy;
    sum[2] = fz;
    sum[3] = area;
    if (free == 0) continue;
    const float bm = fma(half_hh, w[3], half_hh) * u[3];
    if (free & 1) {
      u[0] = fma(bm, fx, u[0]);
      w[0] = fma(bm, fx, w[0]);
    }
    if (free & 2) {
      u[1] = fma(bm, fy, u[1]);
      w[1] = fma(bm, fy, w[1]);
    }
    if (free & 4) {
      u[2] = fma(bm, fz, u[2]);
      w[2] = fma(bm, fz, w[2]);
    }
  }
}
