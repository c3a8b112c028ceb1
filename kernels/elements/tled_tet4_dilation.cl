// First pass of tet4anp: V (J - 1) per tetrahedron into anp_dilation [m^3]. Arguments as in tled_tet4_force.
#include "arith.cl"
#include "texels.cl"
#include "deformation.cl"
#include "tet4.cl"

__kernel void tled_tet4_dilation(__global const float* node_u, __global const int* tet_nodes, __global const float* tet_data,
                                 __global float* anp_dilation) {
  const int e = FIRST_INDEX;
  __global const int* nodes = tet_nodes + TILE_BASE(e, 4);
  __global const float* data = tet_data + TILE_BASE(e, PLIANT_TET_DATA_PLANES);
  const deformation d = deformation_of(tet4_load(node_u, nodes, data).h);
  STORE(DATA(9) * d.j, anp_dilation, e);
}
