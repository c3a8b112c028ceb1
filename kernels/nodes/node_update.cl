// Sum the corner forces at each node and advance it by a step of the integrator (integrator.cl).
// An increment below `still` is taken as none, and a displacement below `fine` is rounded to a multiple of 2^-22 fine (of 2^-23 fine it
// is one anyway above), so that a strain is none or so large that its cube is a normal number: the far field of a wave decays over tens
// of elements, and denormal numbers cost a processor a hundred times what others do. And a body at rest stays at rest.
// node_u: [nodes] (u [m], 1/m [1/kg]); node_w: [nodes] (what the integrator keeps of the motion [m], its decay [1]).
// gather_offset: [tiles + 1] rows; gather_index: [rows][16] positions in corner_force, ascending per node, padded with the position
// of a -0 (adding -0 changes nothing). step_params: h [s], g [m/s^2] (3), still [m], fine [m].
// FORCE_ONLY: write R - F to node_force (without gravity) and leave the node where it is. HAS_LOAD: R from node_load.
#include "arith.cl"
#include "texels.cl"
#include "integrate.cl"

__kernel void node_update(__global float* node_u, __global float* node_w, __global const int* gather_offset,
                          __global const int* gather_index, __global const float* corner_force, __global const float* node_load,
                          __global float* node_force, __global const float* step_params, int node_base) {
  const int i = FIRST_INDEX;
  const int first = gather_offset[i / PLIANT_TILE], last = gather_offset[i / PLIANT_TILE + 1];
#if LANES == 16
  // One lane after the other: three scalar additions per corner beat the sixteen insertions per component of a vector gather.
  float sum[3][16];
  for (int l = 0; l < 16; ++l) {
    float x = -0.0f, y = -0.0f, z = -0.0f;
    for (int k = first; k < last; ++k) {
      __global const float* corner = corner_force + gather_index[k * PLIANT_TILE + l];
      x += corner[0];
      y += corner[PLIANT_TILE];
      z += corner[2 * PLIANT_TILE];
    }
    sum[0][l] = x;
    sum[1][l] = y;
    sum[2][l] = z;
  }
  const real fx = vload16(0, sum[0]), fy = vload16(0, sum[1]), fz = vload16(0, sum[2]);
#else
  float fx = -0.0f, fy = -0.0f, fz = -0.0f;
  for (int k = first; k < last; ++k) {
    __global const float* corner = corner_force + gather_index[k * PLIANT_TILE + i % PLIANT_TILE];
    fx += corner[0];
    fy += corner[PLIANT_TILE];
    fz += corner[2 * PLIANT_TILE];
  }
#endif
  integrate(fx, fy, fz, node_u, node_w, node_load, node_force, step_params, node_base + i);
}
