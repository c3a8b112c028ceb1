// What an interface node takes of its springs beyond what keeps the momentum, as an increment: (beta H^2 / m - alpha) (g - x). With beta =
// alpha m / H^2 the pull on all nodes of shape matching sums to nothing (sum m (g - x) = 0); flsm_damp_update with REACTION gives the
// excess back to the nodes of the regions that made the goal.
// node_u, flsm_slot, flsm_goals, flsm_beta as in flsm_interface; flsm_alpha: [batches]. flsm_excess: [slots] texels [m].
#include "arith.cl"

__kernel void flsm_excess(__global const float* node_u, __global const int* flsm_slot, __global const float* flsm_reference, __global const float* flsm_goals,
                          __global const float* flsm_beta, __global const float* flsm_alpha, __global const float* step_params,
                          __global float* flsm_excess, int batch, int substeps, int region_base) {
  const float h = (float)substeps * step_params[0], hh = h * h;
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int slot = flsm_slot[region_base + i];
    const float4 u = vload4(slot, node_u);
    const float share = fma(flsm_beta[i] * u.w, hh, -flsm_alpha[batch]);
    const float4 excess = share * (vload8(i, flsm_goals).lo - (u - vload4(0, flsm_reference)));
    vstore4((float4)(excess.xyz, 0.0f), slot, flsm_excess);
  }
}
