// Adds the forces of links to the nodes that they act on: node_load[slot] (+)= sum of weight force, in the order of the list.
// gather_node: node_sum.cl. gather_offset: [tiles + 1] rows; gather_index, gather_weight: [rows][16] texels of link_force, and the weight of the point at
// the node [1] (negative where a link stores the opposite force); padded with a texel of zeros and weight 0.
#include "arith.cl"
#include "texels.cl"
#include "node_sum.cl"

__kernel void link_gather(__global float* node_load, __global const int* gather_node, __global const int* gather_offset,
                          __global const int* gather_index, __global const float* gather_weight, __global const float* link_force) {
  const int i = FIRST_INDEX;
  const node_list list = node_list_at(gather_node, i);
#if LANES == 1
  if (list.written[0] < 0) return;
#endif
  real x, y, z;
  node_sum_begin(list, node_load, &x, &y, &z);
  const int last = gather_offset[i / PLIANT_TILE + 1];
  for (int k = gather_offset[i / PLIANT_TILE]; k < last; ++k) {
    const int at = k * PLIANT_TILE + i % PLIANT_TILE;
    const real weight = LOAD(gather_weight, at);
    const texels f = texels_gather(link_force, gather_index + at);
    x = fma(weight, texels_x(f), x);
    y = fma(weight, texels_y(f), y);
    z = fma(weight, texels_z(f), z);
  }
  node_sum_store(list, x, y, z, node_load);
}
