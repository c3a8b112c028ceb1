// Sums the forces of the contact points on each tool (contact_sum.cl), each work-item over a part of the tiles. tool_sum: [steps][tools][PARTS][18]
// force, torque about the tool's origin, and area (each component as two integers, the multiple of 2^15 and the remainder), largest depth at the
// start of the step [m] as bits, number of touching points, and the work of spreading (contact_sum.cl) as two integers.
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "contact_sum.cl"

#define PARTS 16
#define SUM_NUMBERS 18

__kernel void contact_tool_sum(__global const int* contact_tool_force, __global const float* contact_rest,
                               __global const int* contact_list, __global const int* contact_near, __global int* tool_sum, __global const float* contact_params,
                               int point_count, int tools, int step) {
  const int item = (int)get_global_id(0);
  const int t = item / PARTS;
  long sum[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  int deepest = 0, count = 0;
  for (int k = item % PARTS; contact_list[k] >= 0; k += PARTS) {  // the list ends with PARTS empty entries
    const int tile = contact_list[k];
    if (!(contact_near[tile] >> t & 1)) continue;
    for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      __global const int* force = contact_tool_force + TOOL_FORCE_NUMBERS * point_count * t + POINT_BASE(i, TOOL_FORCE_NUMBERS);
      if (force[7 * PLIANT_TILE] == 0) continue;
      for (int c = 0; c < 6; ++c) sum[c] += force[c * PLIANT_TILE];
      sum[6] += quanta(contact_rest[POINT_BASE(i, 4) + 3 * PLIANT_TILE] * contact_params[4]);
      const int depth = force[6 * PLIANT_TILE];  // the bits of non-negative floats sort as the floats
      deepest = depth > deepest ? depth : deepest;
      sum[7] += force[7 * PLIANT_TILE] >> 1;
      ++count;
    }
  }
  __global int* out = tool_sum + SUM_NUMBERS * (step * tools * PARTS + item);
  for (int c = 0; c < 8; ++c) {
    const int at = c < 7 ? 2 * c : 16;
    out[at] = (int)(sum[c] >> 15);
    out[at + 1] = (int)(sum[c] & 32767);
  }
  out[14] = deepest;
  out[15] = count;
}
