// First of three passes from regions back to nodes, in the transposed order: sums of the regions along z links. A node o links above a region's
// centre receives t + o h D e_z; the other columns of D are used in the passes of their axes. flsm_regions: [regions][4] blocks. flsm_link:
// [regions][2] at -z, +z. flsm_plates: [regions][4] blocks: sum t, sum h D e_x, sum h D e_y, 0 [m].
#include "arith.cl"

__kernel void flsm_goal_plate(__global const float* flsm_regions, __global const int* flsm_link, __global float* flsm_plates) {
  const float4 zero = 0.0f;
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    float16 sum = BLOCK16(flsm_regions, i);
    float4 moment = zero;
    int below = i, above = i;
#pragma unroll
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const float16 at_below = BLOCK16(flsm_regions, below), at_above = BLOCK16(flsm_regions, above);
      sum = (sum + at_below) + at_above;
      moment = fma((float4)((float)o), at_below.hi.hi - at_above.hi.hi, moment);
    }
    vstore16((float16)(sum.lo.lo + moment, sum.lo.hi, sum.hi.lo, zero), i, flsm_plates);
  }
}
