// Forces of springs between nodes, node by node: each node adds those of all its springs, by spring_pull.cl, in the order of its list. Both ends compute
// a spring, to the same bits with opposite signs, so that no force is written and gathered again, which would cost more memory traffic.
// spring_node: node_sum.cl. spring_offset: [tiles + 1] rows. spring_end: [rows][16] slot of the other end. spring_data:
// [rows][planes][16] D (3, towards the other end) [m], l0 [m], |D|^2 - l0^2 [m^2], `second`, then `first` if the LAW has one, then the damper of damped
// springs, which is read if VISCOUS.
// Padding of the rows is a spring from the node to itself that is as long as at rest.
#include "arith.cl"
#include "texels.cl"
#include "node_sum.cl"
#include "spring_pull.cl"

#define HAS_FIRST (LAW == 1 || LAW == 2)
#define DATA(k) LOAD(data, (k)*PLIANT_TILE)

__kernel void spring_node(__global float* node_load, __global const float* node_u, __global const float* node_w, __global const int* spring_node,
                          __global const int* spring_offset, __global const int* spring_end, __global const float* spring_data,
                          __global const float* spring_curve, __global const float* step_params, int segments, int planes) {
  const int i = FIRST_INDEX;
  const node_list list = node_list_at(spring_node, i);
#if LANES == 1
  if (list.written[0] < 0) return;
#endif
  const texels u = texels_gather(node_u, list.slot);
  const real ux = texels_x(u), uy = texels_y(u), uz = texels_z(u), none = 0.0f;
  real x, y, z;
  node_sum_begin(list, node_load, &x, &y, &z);
#if VISCOUS
  const texels w = texels_gather(node_w, list.slot);
  const real wx = texels_x(w), wy = texels_y(w), wz = texels_z(w);
#endif
  const int last = spring_offset[i / PLIANT_TILE + 1];
  for (int k = spring_offset[i / PLIANT_TILE]; k < last; ++k) {
    __global const int* end = spring_end + k * PLIANT_TILE + i % PLIANT_TILE;
    __global const float* data = spring_data + k * (planes * PLIANT_TILE) + i % PLIANT_TILE;
    const texels ub = texels_gather(node_u, end);
#if HAS_FIRST
    const real first = DATA(6);
#else
    const real first = none;
#endif
#if VISCOUS
    const texels wb = texels_gather(node_w, end);
    const real vx = texels_x(wb) - wx, vy = texels_y(wb) - wy, vz = texels_z(wb) - wz, damper = DATA(planes - 1);
#else
    const real vx = none, vy = none, vz = none, damper = none;
#endif
    real dx, dy, dz;
    const real scale = spring_pull(DATA(0), DATA(1), DATA(2), texels_x(ub) - ux, texels_y(ub) - uy, texels_z(ub) - uz, DATA(3), DATA(4), first,
                                   DATA(5), spring_curve, segments, vx, vy, vz, damper, step_params[0], &dx, &dy, &dz);
    x = fma(scale, dx, x);
    y = fma(scale, dy, y);
    z = fma(scale, dz, z);
  }
  node_sum_store(list, x, y, z, node_load);
}
