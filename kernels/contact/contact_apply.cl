// Applies the forces of contact points to their nodes immediately: u and w change by b c f / m. Forces are integer quanta and weights integer units,
// so the sum over the nodes equals the sum over the points to the last bit, in any order. contact_slot: [nodes] slots; contact_free: [nodes] bit mask
// of the free components; contact_node_list: tiles of nodes whose points are near something; contact_tiles_offset: [tiles + 1]; contact_tiles: the
// tiles of points at each tile of nodes; contact_entry_offset: [tiles of contact_tiles + 1]; contact_entry: [entries] those of contact_gather that lead
// to that tile of points, in the order of rows; contact_gather_offset: [tiles + 1] rows; contact_gather: [rows][16] positions in contact_force;
// contact_gather_units: [rows][16] weights in units; with MOMENT contact_gather_turns: [rows][2][16] gradients along both tangents in units, which sum to
// zero over a point's nodes, for touch_moment (touch_point.cl). With EDGES contact_gather_corner: [rows][16] index of this node within the point, -1:
// none, for contact_corner_force (contact_edge.cl). contact_node_sum: [slots] (force (3) [N], sum of weights times areas of the touching points [m^2]).
#include "arith.cl"
#include "contact_move.cl"

// Adds what the point of an entry of contact_gather gives to its node, if it touches.
static inline void add_entry(int entry, __global const int* contact_gather, __global const int* contact_gather_units, __global const int* contact_gather_turns,
                             __global const int* contact_near, __global const int* contact_force, __global const int* touch_moment,
                             __global const int* contact_gather_corner, __global const int* contact_corner_force,
                             __global const float* contact_corner_weight, __global const float* contact_rest, long* sum, float* area) {
  const int units = contact_gather_units[entry], at = contact_gather[entry];
  if ((units == 0 && MOMENT == 0 && EDGES == 0) || contact_near[at / (4 * PLIANT_TILE)] == 0 || contact_force[at + 3 * PLIANT_TILE] == 0) return;
  sum[0] += (long)contact_force[at] * units;
  sum[1] += (long)contact_force[at + PLIANT_TILE] * units;
  sum[2] += (long)contact_force[at + 2 * PLIANT_TILE] * units;
#if MOMENT
  if ((contact_near[at / (4 * PLIANT_TILE)] & PLIANT_TOUCH_BIT) != 0) {
    __global const int* moment = touch_moment + at / (4 * PLIANT_TILE) * (PLIANT_TOUCH_MOMENT * PLIANT_TILE) + at % PLIANT_TILE;
    const int turns = 2 * (entry / PLIANT_TILE) * PLIANT_TILE + entry % PLIANT_TILE;
    const int first_turn = contact_gather_turns[turns], second_turn = contact_gather_turns[turns + PLIANT_TILE];
    sum[0] += (long)moment[0] * first_turn + (long)moment[3 * PLIANT_TILE] * second_turn;
    sum[1] += (long)moment[PLIANT_TILE] * first_turn + (long)moment[4 * PLIANT_TILE] * second_turn;
    sum[2] += (long)moment[2 * PLIANT_TILE] * first_turn + (long)moment[5 * PLIANT_TILE] * second_turn;
  }
#endif
  float weight = (float)units * (1.0f / 4096.0f);
#if EDGES
  const int corner = contact_gather_corner[entry];
  if (corner >= 0 && (contact_near[at / (4 * PLIANT_TILE)] & ~PLIANT_TOUCH_BIT) != 0) {
    const int point = at / (4 * PLIANT_TILE), lane = at % PLIANT_TILE;
    __global const int* part = contact_corner_force + point * (24 * PLIANT_TILE) + 3 * corner * PLIANT_TILE + lane;
    __global const float* weights = contact_corner_weight + point * (9 * PLIANT_TILE) + lane;
    sum[0] += (long)part[0] * 4096;
    sum[1] += (long)part[PLIANT_TILE] * 4096;
    sum[2] += (long)part[2 * PLIANT_TILE] * 4096;
    weight = fabs(weights[corner * PLIANT_TILE]) * weights[8 * PLIANT_TILE];
  }
#endif
  *area = fma(weight, contact_rest[at + 3 * PLIANT_TILE], *area);
}

#define ADD_ENTRY(entry, sum, area)                                                                                                             \
  add_entry(entry, contact_gather, contact_gather_units, contact_gather_turns, contact_near, contact_force, touch_moment, contact_gather_corner, \
            contact_corner_force, contact_corner_weight, contact_rest, sum, area)

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
  long sum[3 * LANES];
  float area[LANES];
  for (int l = 0; l < LANES; ++l) sum[3 * l] = 0, sum[3 * l + 1] = 0, sum[3 * l + 2] = 0, area[l] = 0.0f;
#if LANES > 1
  // Few of the points that are near something touch it. One line of a tile of points costs less than the entries that lead to it.
  for (int t = contact_tiles_offset[tile]; t < contact_tiles_offset[tile + 1]; ++t) {
    const int points = contact_tiles[t];
    if (contact_near[points] == 0) continue;
    __global const int* marks = contact_force + points * (4 * PLIANT_TILE) + 3 * PLIANT_TILE;
    int touched = 0;
    for (int l = 0; l < PLIANT_TILE; ++l) touched |= marks[l];
    if (touched == 0) continue;
    for (int e = contact_entry_offset[t]; e < contact_entry_offset[t + 1]; ++e) {
      const int entry = contact_entry[e], l = entry % PLIANT_TILE;
      ADD_ENTRY(entry, sum + 3 * l, area + l);
    }
  }
#else
  for (int k = contact_gather_offset[tile]; k < contact_gather_offset[tile + 1]; ++k) ADD_ENTRY(k * PLIANT_TILE + first % PLIANT_TILE, sum, area);
#endif
  for (int l = 0; l < LANES; ++l) {
    const int slot = contact_slot[first + l], free = contact_free[first + l];
    const float fx = (float)sum[3 * l] * quantum, fy = (float)sum[3 * l + 1] * quantum, fz = (float)sum[3 * l + 2] * quantum;
    __global float* u = node_u + 4 * slot;
    __global float* w = node_w + 4 * slot;
    vstore4((float4)(fx, fy, fz, area[l]), slot, contact_node_sum);
    contact_move(u, w, free, half_hh, fx, fy, fz);
  }
}
