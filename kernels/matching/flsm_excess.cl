// The part of the interface springs that does not conserve momentum, as an increment: (beta H^2 / m - alpha) (g - x). With beta = alpha m / H^2 the
// pulls on all nodes of shape matching sum to zero (sum m (g - x) = 0). flsm_damp_update with REACTION returns the excess to the nodes of the regions
// that define the goal. node_u, flsm_slot, flsm_goals, flsm_beta as in flsm_interface; flsm_alpha: [batches]. flsm_excess: [slots] texels [m].
#include "arith.cl"

__kernel void flsm_excess(__global const float* node_u, __global const int* flsm_slot, __global const float* flsm_reference, __global const float* flsm_goals,
                          __global const float* flsm_beta, __global const float* flsm_alpha, __global const float* step_params,
                          __global float* flsm_excess, int batch, int substeps, int region_base) {
  const float h = (float)substeps * step_params[0], hh = h * h;
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int slot = flsm_slot[region_base + i];
    const float4 u = BLOCK4(node_u, slot);
    const float share = fma(flsm_beta[i] * u.w, hh, -flsm_alpha[batch]);
    const float4 excess = share * (BLOCK8(flsm_goals, i).lo - (u - BLOCK4(flsm_reference, 0)));
    vstore4((float4)(excess.xyz, 0.0f), slot, flsm_excess);
  }
}
