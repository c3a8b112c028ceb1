// Per-region damping of the increments: w <- w + damping (w_rigid - w), with w_rigid the mean over the regions that contain the node; or with
// REACTION w <- w - w_rigid, with the w_rigid of flsm_excess. Both conserve momentum; angular momentum is conserved as far as the rotations of the
// regions are those of their nodes. flsm_bars: [regions][2] blocks of sums of flsm_rates; other arguments as in flsm_goal. Interface nodes, from
// region interface_base on, perform `substeps` steps per shape-matching step, so their w is shorter by this factor. Nodes without inverse mass are
// not changed.
#include "arith.cl"
#include "texels.cl"
#include "flsm_goal_sum.cl"

__kernel void flsm_damp_update(__global const float* node_u, __global float* node_w, __global const int* flsm_slot,
                               __global const float* flsm_bars, __global const int* flsm_link, __global const float* flsm_rates,
                               __global const int* missing_of_offset, __global const int* missing_of, __global const float* missing_of_factor,
                               __global const float* flsm_inverse_holders, float damping, int substeps, int interface_base) {
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int slot = flsm_slot[i];
    const float4 rigid = goal_sum(flsm_bars, flsm_link, flsm_rates, missing_of_offset, missing_of, missing_of_factor, i);
    const float share = i < interface_base ? flsm_inverse_holders[i] : flsm_inverse_holders[i] / (float)substeps;
    const float4 w = BLOCK4(node_w, slot);
#if REACTION
    const float4 next = fma(-rigid, (float4)(share), w);
#else
    const float4 next = fma((float4)(damping), fma(rigid, (float4)(share), -w), w);
#endif
    if (node_u[4 * slot + 3] > 0.0f) vstore4((float4)(next.xyz, w.w), slot, node_w);
  }
}
