// Adds the forces of links to the nodes that they act on: node_load[slot] (+)= sum of weight force, in the order of the list.
// gather_node: [nodes] 2 slot + 1 where another pass has written node_load in this step, to which is added; 2 slot where none has, which is overwritten;
// -1: padding. gather_offset: [tiles + 1] rows; gather_index, gather_weight: [rows][16] positions in link_force of the x component of a force on a point,
// 16 numbers from the next component, and the weight of the point at the node [1] (negative where a link stores the opposite force); padded with the
// position of a 0 and weight 0.
#include "arith.cl"

__kernel void link_gather(__global float* node_load, __global const int* gather_node, __global const int* gather_offset,
                          __global const int* gather_index, __global const float* gather_weight, __global const float* link_force) {
  for (int i = FIRST_INDEX; i < FIRST_INDEX + LANES; ++i) {
    const int node = gather_node[i];
    if (node >= 0) {
      __global float* load = node_load + 4 * (node / 2);
      float x = 0.0f, y = 0.0f, z = 0.0f;
      if (node % 2 > 0) {
        x = load[0];
        y = load[1];
        z = load[2];
      }
      const int last = gather_offset[i / PLIANT_TILE + 1];
      for (int k = gather_offset[i / PLIANT_TILE]; k < last; ++k) {
        const int at = k * PLIANT_TILE + i % PLIANT_TILE;
        const float weight = gather_weight[at];
        __global const float* f = link_force + gather_index[at];
        x = fma(weight, f[0], x);
        y = fma(weight, f[PLIANT_TILE], y);
        z = fma(weight, f[2 * PLIANT_TILE], z);
      }
      load[0] = x;
      load[1] = y;
      load[2] = z;
    }
  }
}
