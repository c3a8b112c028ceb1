// Sums the corner forces at each node and advances it by a step of the integrator (integrator.cl). Increments below `still` become 0, and
// displacements below `fine` are rounded to a multiple of 2^-22 fine (above, they are a multiple of 2^-23 fine anyway). So a strain is either 0 or
// large enough that its cube is a normal number: the far field of a wave decays over tens of elements, and denormal numbers cost a processor a
// hundred times more than others. It also keeps a body at rest. node_u: [nodes] (u [m], 1/m [1/kg]); node_w: [nodes] (motion as the integrator stores
// it [m], its decay [1]). gather_offset: [tiles + 1] rows; gather_index: [rows][16] positions in corner_force, ascending per node, padded with the
// position of a -0 (adding -0 changes nothing). step_params: h [s], g [m/s^2] (3), still [m], fine [m]. FORCE_ONLY: writes R - F to node_force
// (without gravity) and does not move the node. HAS_LOAD: R from node_load.
#include "arith.cl"
#include "texels.cl"
#include "integrate.cl"

__kernel void node_update(__global float* node_u, __global float* node_w, __global const int* gather_offset,
                          __global const int* gather_index, __global const float* corner_force, __global const float* node_load,
                          __global float* node_force, __global const float* step_params, int node_base) {
  const int i = FIRST_INDEX;
  const int first = gather_offset[i / PLIANT_TILE], last = gather_offset[i / PLIANT_TILE + 1];
#if LANES == 16
  // Lane by lane: three scalar additions per corner are faster than the sixteen insertions per component of a vector gather.
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
