// Advances the nodes that only shape matching moves (Hybrid Deformation Model, equations 6, 8 and 9, in increments w = H v):
//   w <- a w + alpha (g - x) + b (R / m + g),  u <- u + w,  H = substeps h, a and b as in node_update for the step H.
// flsm_alpha: [batches]. The slots of these nodes are consecutive from node_base; region i belongs to node i. Arguments as in flsm_goal and
// node_update. A node whose displacement is not finite is marked in `fault`. HAS_LOAD: R from node_load.
#include "arith.cl"
#include "texels.cl"
#include "flsm_goal_sum.cl"

__kernel void flsm_update(__global float* node_u, __global float* node_w, __global const float* node_load,
                          __global const float* flsm_bars, __global const int* flsm_link, __global const float* flsm_regions,
                          __global const int* missing_of_offset, __global const int* missing_of, __global const float* missing_of_factor,
                          __global const float* flsm_inverse_holders, __global const float* flsm_reference,
                          __global const float* step_params, __global const float* flsm_alpha,
                          __global int* fault, int batch, int substeps, int node_base, int fault_base, int step) {
  const float4 zero = 0.0f;
  const float h = (float)substeps * step_params[0], half_hh = (0.5f * h) * h;
  const float still = step_params[4], fine = step_params[5], anchor = 3.0f * fine;
  const float4 gravity = (float4)(step_params[1], step_params[2], step_params[3], 0.0f);
  const float4 origin = BLOCK4(flsm_reference, 0);
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const float4 goal = goal_sum(flsm_bars, flsm_link, flsm_regions, missing_of_offset, missing_of, missing_of_factor, i);
    const float4 u = BLOCK4(node_u, node_base + i), w = BLOCK4(node_w, node_base + i);
    const float b = fma(half_hh, w.w, half_hh);
#if HAS_LOAD
    const float4 push = fma((float4)(b * u.w), BLOCK4(node_load, node_base + i), b * gravity);
#else
    const float4 push = b * gravity;
#endif
    const float4 full = fma((float4)(flsm_alpha[batch]), fma(goal, (float4)(flsm_inverse_holders[i]), -(u - origin)), fma((float4)(w.w), w, push));
    const float4 moved = fabs(full) < still ? zero : full;
    const float4 next = u.w > 0.0f ? moved : zero;
    const float4 sum = u + next;
    const float4 placed = fabs(sum) < fine ? (sum + anchor) - anchor : sum;
    vstore4((float4)(next.xyz, w.w), node_base + i, node_w);
    vstore4((float4)(placed.xyz, u.w), node_base + i, node_u);
    const int finite = fabs(placed.x) < INFINITY && fabs(placed.y) < INFINITY && fabs(placed.z) < INFINITY;
    if (!finite && fault[fault_base + i] <= 0) fault[fault_base + i] = step + 1;
  }
}
