// Last pass from regions back to nodes: the sum of T X - X over the regions that contain node i [m], along x links, plus the regions that no path x,
// y, z reaches. missing_of_offset: [regions + 1]; missing_of: [entries] regions; missing_of_factor: [entries] blocks.
#include "flsm_records.cl"

static inline float4 goal_sum(__global const float* flsm_bars, __global const int* flsm_link, __global const float* flsm_regions,
                              __global const int* missing_of_offset, __global const int* missing_of, __global const float* missing_of_factor, int i) {
  float4 sum = BLOCK4(flsm_bars, 2 * i), moment = 0.0f;
  int below = i, above = i;
#pragma unroll
  for (int o = 1; o <= WIDTH; ++o) {
    below = flsm_link[2 * below];
    above = flsm_link[2 * above + 1];
    const float8 at_below = BLOCK8(flsm_bars, below), at_above = BLOCK8(flsm_bars, above);
    sum = (sum + at_below.lo) + at_above.lo;
    moment = fma((float4)((float)o), at_below.hi - at_above.hi, moment);
  }
  sum = sum + moment;
  const int first = missing_of_offset[i], last = missing_of_offset[i + 1];
  if (first == last) return sum;
  float16 listed = -0.0f;
  for (int e = first; e < last; ++e) listed = add_entry(missing_of_factor, e, BLOCK16(flsm_regions, missing_of[e]), listed);
  sum = sum + ((listed.lo.lo + listed.lo.hi) + (listed.hi.lo + listed.hi.hi));
  return sum;
}
