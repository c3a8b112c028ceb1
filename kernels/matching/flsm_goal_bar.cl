// Second pass back from regions to nodes: sums along y links (see flsm_goal_plate).
// flsm_plates: [regions][4] blocks. flsm_link: [regions][2] at -y, +y. flsm_bars: [regions][2] blocks: sum t, sum h D e_x [m].
#include "arith.cl"

__kernel void flsm_goal_bar(__global const float* flsm_plates, __global const int* flsm_link, __global float* flsm_bars) {
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    float8 sum = vload8(2 * i, flsm_plates);
    float4 moment = 0.0f;
    int below = i, above = i;
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      sum = (sum + vload8(2 * below, flsm_plates)) + vload8(2 * above, flsm_plates);
      moment = fma((float4)((float)o), vload4(4 * below + 2, flsm_plates) - vload4(4 * above + 2, flsm_plates), moment);
    }
    vstore8((float8)(sum.lo + moment, sum.hi), i, flsm_bars);
  }
}
