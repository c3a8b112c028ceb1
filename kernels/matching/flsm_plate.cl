// Second pass from nodes to regions: sums of bars along y links (see flsm_bar).
// flsm_bars: [regions][2] blocks. flsm_link: [regions][2] at -y, +y. flsm_plates: [regions][4] blocks: sum m u, sum o_x m u,
// sum o_y m u, 0 [kg m].
#include "arith.cl"

__kernel void flsm_plate(__global const float* flsm_bars, __global const int* flsm_link, __global float* flsm_plates) {
  const float4 zero = 0.0f;
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    float8 sum = BLOCK8(flsm_bars, i);
    float4 moment = zero;
    int below = i, above = i;
#pragma unroll
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const float8 at_below = BLOCK8(flsm_bars, below), at_above = BLOCK8(flsm_bars, above);
      sum = (sum + at_below) + at_above;
      moment = fma((float4)((float)o), at_above.lo - at_below.lo, moment);
    }
    vstore16((float16)(sum, moment, zero), i, flsm_plates);
  }
}
