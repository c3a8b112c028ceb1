// Fast lattice shape matching, first of three passes from nodes to regions (Rivers and James 2007, section 4.2): sums along the x links of a node, up
// to WIDTH links on each side: sum m u and sum o m u, with weights m and the number of links o. The sums use displacements, because float positions
// far from the origin would lose precision. RELATIVE: displacements are relative to that of the first region's node; otherwise rounding of the
// weights would accelerate a body that has moved far. flsm_reference: [2] texels, this displacement and that of the previous shape-matching step.
//
// A weight of 0 and links to itself mark the region that replaces absent ones. All FLSM data are in blocks of four numbers (x, y, z and one unused).
// node_u: [slots] texels. flsm_slot: [regions]. flsm_weight: [regions] m [kg]. flsm_link: [regions][2] at -x, +x. flsm_bars: [regions][2] blocks: sum
// m u, sum o_x m u [kg m].
#include "arith.cl"

__kernel void flsm_bar(__global const float* node_u, __global const int* flsm_slot, __global const float* flsm_weight,
                       __global const int* flsm_link, __global float* flsm_reference, __global float* flsm_bars) {
  const float4 zero = 0.0f;
#if RELATIVE
  const float4 origin = BLOCK4(node_u, flsm_slot[0]);
  if (get_global_id(0) == 0) vstore8((float8)(origin, BLOCK4(flsm_reference, 0)), 0, flsm_reference);
#else
  const float4 origin = zero;
#endif
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    float4 sum = fma((float4)(flsm_weight[i]), BLOCK4(node_u, flsm_slot[i]) - origin, zero), moment = zero;
    int below = i, above = i;
#pragma unroll
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const float4 u_below = BLOCK4(node_u, flsm_slot[below]) - origin, u_above = BLOCK4(node_u, flsm_slot[above]) - origin;
      const float m_below = flsm_weight[below], m_above = flsm_weight[above];
      sum = fma((float4)(m_above), u_above, fma((float4)(m_below), u_below, sum));
      moment = fma((float4)((float)o * m_above), u_above, fma((float4)(-((float)o * m_below)), u_below, moment));
    }
    vstore8((float8)(sum, moment), i, flsm_bars);
  }
}
