// Second pass of tet4anp: averaged nodal pressure p_n = dU/dJ at J - 1 = sum_e V_e (J_e - 1) / sum_e V_e, summed over the batch's elements at the
// node (Bonet and Burton 1998; Joldes, Wittek and Miller 2009). anp_offset: [node tiles + 1] rows; anp_index: [rows][16] elements, ascending per
// node, padded with an element whose dilation is -0.
#include "arith.cl"
#include "texels.cl"
#include "law.cl"

__kernel void anp_node_pressure(__global const float* anp_dilation, __global const int* anp_offset, __global const int* anp_index,
                                __global const float* anp_inverse_volume, __global float* anp_pressure,
                                __global const float* law_parameters, int node_base) {
  const int i = FIRST_INDEX;
  const int first = anp_offset[i / PLIANT_TILE], last = anp_offset[i / PLIANT_TILE + 1];
  real sum = -0.0f;
  for (int k = first; k < last; ++k) sum += gather(anp_dilation, anp_index + k * PLIANT_TILE + i % PLIANT_TILE);
  STORE(law_pressure(law_load(law_parameters), sum * LOAD(anp_inverse_volume, i)), anp_pressure, node_base + i);
}
