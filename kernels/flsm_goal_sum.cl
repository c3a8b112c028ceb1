// Last pass back from regions to nodes: the sum of T X - X over the regions that hold node i [m], along x links, then the regions that
// reach it on no path x, y, z. missing_of_offset: [regions + 1]; missing_of: [entries][2] region and packed offset of the node from its
// centre.
#include "flsm_records.cl"

static inline float4 goal_sum(__global const float* flsm_bars, __global const int* flsm_link, __global const float* flsm_regions,
                              __global const int* missing_of_offset, __global const int* missing_of, int i) {
  float4 sum = vload4(2 * i, flsm_bars), moment = 0.0f;
  int below = i, above = i;
  for (int o = 1; o <= WIDTH; ++o) {
    below = flsm_link[2 * below];
    above = flsm_link[2 * above + 1];
    const float8 at_below = vload8(below, flsm_bars), at_above = vload8(above, flsm_bars);
    sum = (sum + at_below.lo) + at_above.lo;
    moment = fma((float4)((float)o), at_below.hi - at_above.hi, moment);
  }
  sum = sum + moment;
  for (int e = missing_of_offset[i]; e < missing_of_offset[i + 1]; ++e) {
    const int packed = missing_of[2 * e + 1];
    const float16 region = vload16(missing_of[2 * e], flsm_regions);
    sum = fma((float4)(OFFSET_X(packed)), region.lo.hi, sum + region.lo.lo);
    sum = fma((float4)(OFFSET_Z(packed)), region.hi.hi, fma((float4)(OFFSET_Y(packed)), region.hi.lo, sum));
  }
  return sum;
}
