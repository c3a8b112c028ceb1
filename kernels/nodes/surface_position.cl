// Positions of the embedded surface: x = X + sum_a weight_a u(node_a) [m].
// surface_rest: [vertices] texels [m]; surface_node, surface_weight: [tiles][8][16]. WIDTH: 8 (lattice) or 1 (the vertex is a node).
#include "arith.cl"
#include "texels.cl"

__kernel void surface_position(__global const float* node_u, __global const float* surface_rest, __global const int* surface_node,
                               __global const float* surface_weight, __global float* surface_x) {
  const int i = FIRST_INDEX;
  __global const int* nodes = surface_node + TILE_BASE(i, WIDTH);
  __global const float* weights = surface_weight + TILE_BASE(i, WIDTH);
  const texels rest = texels_load(surface_rest, i);
  real x = 0.0f, y = 0.0f, z = 0.0f;
  for (int a = 0; a < WIDTH; ++a) {
    const texels u = texels_gather(node_u, nodes + a * PLIANT_TILE);
    const real weight = LOAD(weights, a * PLIANT_TILE);
    x = fma(weight, texels_x(u), x);
    y = fma(weight, texels_y(u), y);
    z = fma(weight, texels_z(u), z);
  }
  texels_store(texels_x(rest) + x, texels_y(rest) + y, texels_z(rest) + z, texels_w(rest), surface_x, i);
}
