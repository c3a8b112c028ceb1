// Applies the forces of the samples of blades to their nodes at once, as contact_apply does: u and w change by b f / m. blade_slot: [nodes] slots, ascending,
// -1: none; blade_free: [nodes] bit mask of the free components; blade_first: [nodes + 1] into blade_entry: positions in blade_weight, ascending;
// blade_weight: [samples][8]; blade_force: [steps][samples][4] [N].
#include "arith.cl"
#include "contact_move.cl"

__kernel void blade_apply(__global float* node_u, __global float* node_w, __global const int* blade_slot, __global const int* blade_free,
                          __global const int* blade_first, __global const int* blade_entry, __global const float* blade_weight,
                          __global const float* blade_force, __global const float* step_params, int samples, int step) {
  const int i = (int)get_global_id(0);
  const int slot = blade_slot[i], free = blade_free[i];
  if (slot < 0 || free == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h;
  float fx = 0.0f, fy = 0.0f, fz = 0.0f;
  for (int k = blade_first[i]; k < blade_first[i + 1]; ++k) {
    const int entry = blade_entry[k];
    __global const float* force = blade_force + 4 * (step * samples + entry / 8);
    const float weight = blade_weight[entry];
    fx = fma(weight, force[0], fx);
    fy = fma(weight, force[1], fy);
    fz = fma(weight, force[2], fz);
  }
  contact_move(node_u + 4 * slot, node_w + 4 * slot, free, half_hh, fx, fy, fz);
}
