// Displacements of the points of links, sum of weight u over the slots of each. A node is a point with one slot and weight 1, and keeps its bits.
// point_offset: [tiles + 1] rows; point_slot, point_weight: [rows][16] slots and weights [1] of each point, padded with weight 0. link_u: [points] (u
// [m], 0). VISCOUS: link_w: [points] likewise the last increment [m].
#include "arith.cl"
#include "texels.cl"

__kernel void link_points(__global const float* node_u, __global const float* node_w, __global const int* point_offset,
                          __global const int* point_slot, __global const float* point_weight, __global float* link_u, __global float* link_w) {
  const int i = FIRST_INDEX;
  const int first = point_offset[i / PLIANT_TILE], last = point_offset[i / PLIANT_TILE + 1];
  const real none = 0.0f;
  real x = none, y = none, z = none;
#if VISCOUS
  real wx = none, wy = none, wz = none;
#endif
  for (int k = first; k < last; ++k) {
    const int at = k * PLIANT_TILE + i % PLIANT_TILE;
    const real weight = LOAD(point_weight, at);
    const texels u = texels_gather(node_u, point_slot + at);
    x = fma(weight, texels_x(u), x);
    y = fma(weight, texels_y(u), y);
    z = fma(weight, texels_z(u), z);
#if VISCOUS
    const texels w = texels_gather(node_w, point_slot + at);
    wx = fma(weight, texels_x(w), wx);
    wy = fma(weight, texels_y(w), wy);
    wz = fma(weight, texels_z(w), wz);
#endif
  }
  texels_store(x, y, z, none, link_u, i);
#if VISCOUS
  texels_store(wx, wy, wz, none, link_w, i);
#endif
}
