// Displacement gradient of a linear tetrahedron: H = sum_a (u_a - u_0) (x) grad N_a, a = 1..3.
#define DATA(plane) LOAD(data, (plane)*PLIANT_TILE)
typedef struct {
  mat3 h;                                            // [1]
  real b1x, b1y, b1z, b2x, b2y, b2z, b3x, b3y, b3z;  // grad N_1..3 [1/m]
} tet4;

// `nodes` and `data` point to this work-item's lanes of tet_nodes ([4][16] per tile) and tet_data ([10][16] per tile).
static inline tet4 tet4_load(__global const float* node_u, __global const int* nodes, __global const float* data) {
  const texels u0 = texels_gather(node_u, nodes), u1 = texels_gather(node_u, nodes + PLIANT_TILE);
  const texels u2 = texels_gather(node_u, nodes + 2 * PLIANT_TILE), u3 = texels_gather(node_u, nodes + 3 * PLIANT_TILE);
  const real x0 = texels_x(u0), y0 = texels_y(u0), z0 = texels_z(u0);
  const real x1 = texels_x(u1) - x0, y1 = texels_y(u1) - y0, z1 = texels_z(u1) - z0;
  const real x2 = texels_x(u2) - x0, y2 = texels_y(u2) - y0, z2 = texels_z(u2) - z0;
  const real x3 = texels_x(u3) - x0, y3 = texels_y(u3) - y0, z3 = texels_z(u3) - z0;
  tet4 tet;
  tet.b1x = DATA(0), tet.b1y = DATA(1), tet.b1z = DATA(2);
  tet.b2x = DATA(3), tet.b2y = DATA(4), tet.b2z = DATA(5);
  tet.b3x = DATA(6), tet.b3y = DATA(7), tet.b3z = DATA(8);
  tet.h.m00 = fma(x3, tet.b3x, fma(x2, tet.b2x, x1 * tet.b1x));
  tet.h.m01 = fma(x3, tet.b3y, fma(x2, tet.b2y, x1 * tet.b1y));
  tet.h.m02 = fma(x3, tet.b3z, fma(x2, tet.b2z, x1 * tet.b1z));
  tet.h.m10 = fma(y3, tet.b3x, fma(y2, tet.b2x, y1 * tet.b1x));
  tet.h.m11 = fma(y3, tet.b3y, fma(y2, tet.b2y, y1 * tet.b1y));
  tet.h.m12 = fma(y3, tet.b3z, fma(y2, tet.b2z, y1 * tet.b1z));
  tet.h.m20 = fma(z3, tet.b3x, fma(z2, tet.b2x, z1 * tet.b1x));
  tet.h.m21 = fma(z3, tet.b3y, fma(z2, tet.b2y, z1 * tet.b1y));
  tet.h.m22 = fma(z3, tet.b3z, fma(z2, tet.b2z, z1 * tet.b1z));
  return tet;
}
