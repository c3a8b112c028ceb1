// Second pass back from regions to nodes: sums along y links (see flsm_goal_plate).
// flsm_plates: [regions][4] blocks. flsm_link: [regions][2] at -y, +y. flsm_bars: [regions][2] blocks: sum t, sum h D e_x [m].
#include "arith.cl"

__kernel void flsm_goal_bar(__global const float* flsm_plates, __global const int* flsm_link, __global float* flsm_bars) {
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    float8 sum = BLOCK8(flsm_plates, 2 * i);
    float4 moment = 0.0f;
    int below = i, above = i;
#pragma unroll
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      sum = (sum + BLOCK8(flsm_plates, 2 * below)) + BLOCK8(flsm_plates, 2 * above);
      moment = fma((float4)((float)o), BLOCK4(flsm_plates, 4 * below + 2) - BLOCK4(flsm_plates, 4 * above + 2), moment);
    }
    vstore8((float8)(sum.lo + moment, sum.hi), i, flsm_bars);
  }
}
