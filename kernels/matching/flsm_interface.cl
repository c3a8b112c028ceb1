// The spring force on interface nodes, F' = beta (g - x) (Hybrid Deformation Model, equation 7), added to node_load. Between two shape-matching
// steps, H = substeps h apart, the goals are held, or EXTRAPOLATED along g - (previous g). flsm_slot: [regions]; flsm_goals: [interface][2] blocks
// [m]; flsm_beta: [interface] [N/m]. step_params[6]: steps since the start of the run, modulo a multiple of `substeps`, at the first step of the
// batch.
#include "arith.cl"

__kernel void flsm_interface(__global const float* node_u, __global float* node_load, __global const int* flsm_slot,
                             __global const float* flsm_reference, __global const float* flsm_goals, __global const float* flsm_beta, __global const float* step_params,
                             int substeps, int region_base, int step) {
#if EXTRAPOLATED
  const float ahead = (float)(((int)step_params[6] + step) % substeps) / (float)substeps;
#endif
  const float4 origin = BLOCK4(flsm_reference, 0);
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int slot = flsm_slot[region_base + i];
    const float8 goals = BLOCK8(flsm_goals, i);
#if EXTRAPOLATED
    const float4 goal = fma((float4)(ahead), goals.lo - goals.hi, goals.lo);
#else
    const float4 goal = goals.lo;
#endif
    const float4 force = fma((float4)(flsm_beta[i]), goal - (BLOCK4(node_u, slot) - origin), BLOCK4(node_load, slot));
    vstore4((float4)(force.xyz, 0.0f), slot, node_load);
  }
}
