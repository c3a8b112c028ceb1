// Goals of the interface nodes: stores the mean displacement g - X over the regions that contain the node (Hybrid Deformation Model, equation 6) in
// flsm_goals, together with the previous one; both are relative to the first texel of flsm_reference. flsm_inverse_holders: [regions] 1 / number of
// regions that contain the node. flsm_goals: [interface][2] blocks [m]. region_base: region of the first interface node; other buffers as in
// flsm_goal_sum.
#include "arith.cl"
#include "texels.cl"
#include "flsm_goal_sum.cl"

__kernel void flsm_goal(__global const float* flsm_bars, __global const int* flsm_link, __global const float* flsm_regions,
                        __global const int* missing_of_offset, __global const int* missing_of, __global const float* missing_of_factor,
                        __global const float* flsm_inverse_holders, __global const float* flsm_reference, __global float* flsm_goals, int region_base) {
  const float4 moved = BLOCK4(flsm_reference, 1) - BLOCK4(flsm_reference, 0);
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int region = region_base + i;
    const float4 goal = goal_sum(flsm_bars, flsm_link, flsm_regions, missing_of_offset, missing_of, missing_of_factor, region) * flsm_inverse_holders[region];
    vstore8((float8)(goal, BLOCK4(flsm_goals, 2 * i) + moved), i, flsm_goals);
  }
}
