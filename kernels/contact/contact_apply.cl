// Applies the forces of contact points to their nodes immediately: u and w change by b c f / m. Forces are integer quanta and weights integer units,
// so the sum over the nodes equals the sum over the points to the last bit, in any order. contact_slot: [nodes] slots, -1: padding; contact_free: [nodes] bit
// mask of the free components; contact_node_list: tiles of nodes whose points are near something; contact_tiles_offset: [tiles + 1]; contact_tiles:
// the tiles of points at each tile of nodes; contact_entry_offset: [tiles of contact_tiles + 1]; contact_entry: [entries][4] the entries of contact_gather
// that lead to that tile of points, in the order of rows: lane of the node + 16 * lane of the point + 256 * contact_gather_corner, weight in units,
// both gradients; contact_gather_offset: [tiles + 1] rows; contact_gather: [rows][16] positions in contact_force; contact_gather_units: [rows][16]
// weights in units; with MOMENT contact_gather_turns: [rows][2][16] gradients along both tangents in units, which sum to zero over a point's nodes, for
// touch_moment (touch_point.cl). With EDGES contact_gather_corner: [rows][16] index of this node within the point, -1: none, for contact_corner_force
// (contact_edge.cl). contact_node_sum: [slots] (force (3) [N], sum of weights times areas of the touching points [m^2]).
#include "arith.cl"
#include "contact_move.cl"

// What one point gives to one of its nodes, if it touches: `sum` [quanta], `area`. tile, lane: of the point; near: contact_near of that tile.
static inline void add_entry(int tile, int lane, int near, int units, int first_turn, int second_turn, int corner,
                             __global const int* contact_force, __global const int* touch_moment, __global const int* contact_corner_force,
                             __global const float* contact_corner_weight, __global const float* contact_rest, long4* sum, float* area) {
  __global const int* force = contact_force + tile * (4 * PLIANT_TILE) + lane;
  if (force[3 * PLIANT_TILE] == 0) return;
  *sum += convert_long4((int4)(force[0], force[PLIANT_TILE], force[2 * PLIANT_TILE], 0)) * (long4)(units);
#if MOMENT
  if ((near & PLIANT_TOUCH_BIT) != 0) {
    __global const int* moment = touch_moment + PLIANT_TOUCH_MOMENT * (tile * PLIANT_TILE + lane);
    *sum += convert_long4(vload4(0, moment)) * (long4)(first_turn) + convert_long4(vload4(1, moment)) * (long4)(second_turn);
  }
#endif
  float weight = (float)units * (1.0f / 4096.0f);
#if EDGES
  if (corner >= 0 && (near & ~PLIANT_TOUCH_BIT) != 0) {
    __global const int* part = contact_corner_force + tile * (24 * PLIANT_TILE) + 3 * corner * PLIANT_TILE + lane;
    __global const float* weights = contact_corner_weight + tile * (9 * PLIANT_TILE) + lane;
    *sum += convert_long4((int4)(part[0], part[PLIANT_TILE], part[2 * PLIANT_TILE], 0)) * (long4)(4096);
    weight = fabs(weights[corner * PLIANT_TILE]) * weights[8 * PLIANT_TILE];
  }
#endif
  *area = fma(weight, contact_rest[tile * (4 * PLIANT_TILE) + 3 * PLIANT_TILE + lane], *area);
}

__kernel void contact_apply(__global float* node_u, __global float* node_w, __global const int* contact_slot,
                            __global const int* contact_free, __global const int* contact_node_list,
                            __global const int* contact_tiles_offset, __global const int* contact_tiles,
                            __global const int* contact_entry_offset, __global const int* contact_entry,
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
  long4 sum[LANES];
  float area[LANES];
  for (int l = 0; l < LANES; ++l) sum[l] = 0, area[l] = 0.0f;
#if LANES > 1
  // Few of the points that are near something touch it. One line of a tile of points costs less than the entries that lead to it.
  for (int t = contact_tiles_offset[tile]; t < contact_tiles_offset[tile + 1]; ++t) {
    const int points = contact_tiles[t], near = contact_near[points];
    if (near == 0) continue;
    if (!ANY(LOAD(contact_force, points * (4 * PLIANT_TILE) + 3 * PLIANT_TILE) != 0)) continue;
    for (int e = contact_entry_offset[t]; e < contact_entry_offset[t + 1]; ++e) {
      const int4 entry = vload4(e, contact_entry);
      const int l = entry.x & 15;
      add_entry(points, entry.x >> 4 & 15, near, entry.y, entry.z, entry.w, entry.x >> 8, contact_force, touch_moment,
                contact_corner_force, contact_corner_weight, contact_rest, sum + l, area + l);
    }
  }
#else
  for (int k = contact_gather_offset[tile]; k < contact_gather_offset[tile + 1]; ++k) {
    const int entry = k * PLIANT_TILE + first % PLIANT_TILE, units = contact_gather_units[entry];
    const int at = contact_gather[entry], points = at / (4 * PLIANT_TILE), near = contact_near[points];
    if ((units == 0 && MOMENT == 0 && EDGES == 0) || near == 0) continue;
    const int turns = 2 * k * PLIANT_TILE + first % PLIANT_TILE;
    add_entry(points, at % PLIANT_TILE, near, units, MOMENT ? contact_gather_turns[turns] : 0, MOMENT ? contact_gather_turns[turns + PLIANT_TILE] : 0,
              EDGES ? contact_gather_corner[entry] : -1, contact_force, touch_moment, contact_corner_force, contact_corner_weight, contact_rest, sum,
              area);
  }
#endif
  for (int l = 0; l < LANES; ++l) {
    const int slot = contact_slot[first + l], free = contact_free[first + l];
    if (slot < 0) continue;
    const float fx = (float)sum[l].x * quantum, fy = (float)sum[l].y * quantum, fz = (float)sum[l].z * quantum;
    __global float* u = node_u + 4 * slot;
    __global float* w = node_w + 4 * slot;
    vstore4((float4)(fx, fy, fz, area[l]), slot, contact_node_sum);
    contact_move(u, w, free, half_hh, fx, fy, fz);
  }
}
