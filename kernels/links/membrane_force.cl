// Corner forces of membrane triangles: f_a = V P grad N_a (total Lagrangian, constant strain, plane stress, the law of St Venant
// and Kirchhoff; Bonet et al. 2000, "Finite element analysis of air supported membrane structures"). With the unit tangents T_1,
// T_2 at rest and G_k = sum_a u_a dN_a/dX_k:
//   F_k = T_k + G_k,  E_kk = T_k . G_k + G_k . G_k / 2,  2 E_12 = T_1 . G_2 + T_2 . G_1 + G_1 . G_2
//   S_11 = c (E_11 + nu E_22),  S_22 = c (E_22 + nu E_11),  S_12 = c (1 - nu) E_12,  c = E / (1 - nu^2);  P_k = F_1 S_1k + F_2 S_2k
// Strain is computed from displacements, so that no digits cancel where it is small.
// link_u: texels, displacements of the links' points [m]. membrane_points: [tiles][3][16] texels of link_u.
// membrane_data: [tiles][10][16] T_1, T_2 [1], dN_1/dX_1, dN_1/dX_2, dN_2/dX_2 [1/m] (dN_2/dX_1 is 0), V [m^3].
// link_force: texels [tiles][3 corners][16] from force_base on [N]. stiffness: c [Pa]. ratio: nu [1].
#include "arith.cl"
#include "texels.cl"

#define DATA(plane) LOAD(data, (plane)*PLIANT_TILE)
#define DOT(a, b) fma(a##z, b##z, fma(a##y, b##y, a##x * b##x))

__kernel void membrane_force(__global const float* link_u, __global const int* membrane_points, __global const float* membrane_data,
                             __global float* link_force, float stiffness, float ratio, int force_base) {
  const int e = FIRST_INDEX;
  __global const int* points = membrane_points + TILE_BASE(e, 3);
  __global const float* data = membrane_data + TILE_BASE(e, PLIANT_MEMBRANE_DATA_PLANES);
  const texels u0 = texels_gather(link_u, points), u1 = texels_gather(link_u, points + PLIANT_TILE);
  const texels u2 = texels_gather(link_u, points + 2 * PLIANT_TILE);
  const real x0 = texels_x(u0), y0 = texels_y(u0), z0 = texels_z(u0);
  const real b11 = DATA(6), b12 = DATA(7), b22 = DATA(8), v = DATA(9), none = 0.0f;
  const real v1x = texels_x(u1) - x0, v1y = texels_y(u1) - y0, v1z = texels_z(u1) - z0;
  const real v2x = texels_x(u2) - x0, v2y = texels_y(u2) - y0, v2z = texels_z(u2) - z0;
  const real g1x = v1x * b11, g1y = v1y * b11, g1z = v1z * b11;
  const real g2x = fma(v2x, b22, v1x * b12), g2y = fma(v2y, b22, v1y * b12), g2z = fma(v2z, b22, v1z * b12);
  const real t1x = DATA(0), t1y = DATA(1), t1z = DATA(2), t2x = DATA(3), t2y = DATA(4), t2z = DATA(5);
  const real e11 = fma(0.5f, DOT(g1, g1), DOT(t1, g1)), e22 = fma(0.5f, DOT(g2, g2), DOT(t2, g2));
  const real e12 = 0.5f * (DOT(g1, g2) + (DOT(t1, g2) + DOT(t2, g1)));
  const real c = stiffness * v;
  const real s11 = c * fma(ratio, e22, e11), s22 = c * fma(ratio, e11, e22), s12 = c * ((1.0f - ratio) * e12);
  const real f1x = fma(v1x, b11, t1x), f1y = fma(v1y, b11, t1y), f1z = fma(v1z, b11, t1z);
  const real f2x = t2x + g2x, f2y = t2y + g2y, f2z = t2z + g2z;
  // P_1 and P_2, times V.
  const real p1x = fma(f2x, s12, f1x * s11), p1y = fma(f2y, s12, f1y * s11), p1z = fma(f2z, s12, f1z * s11);
  const real p2x = fma(f2x, s22, f1x * s12), p2y = fma(f2y, s22, f1y * s12), p2z = fma(f2z, s22, f1z * s12);
  const real a1x = fma(p2x, b12, p1x * b11), a1y = fma(p2y, b12, p1y * b11), a1z = fma(p2z, b12, p1z * b11);
  const real a2x = p2x * b22, a2y = p2y * b22, a2z = p2z * b22;
  const int out = force_base + TILE_BASE(e, 3);
  texels_store(-fma(p2x, b22, a1x), -fma(p2y, b22, a1y), -fma(p2z, b22, a1z), none, link_force, out);
  texels_store(a1x, a1y, a1z, none, link_force, out + PLIANT_TILE);
  texels_store(a2x, a2y, a2z, none, link_force, out + 2 * PLIANT_TILE);
}
