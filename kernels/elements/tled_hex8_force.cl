// Corner forces of 8-node hexahedra with one point and total Lagrangian hourglass control (Flanagan and Belytschko 1981; Joldes,
// Wittek and Miller 2008): f_a = fill (V P b_a + k sum_i gamma_ia q_i) with q_i = sum_a gamma_ia u_a.
// A cube (UNIFORM) has one stiffness for all its modes; other shapes use hex8_hourglass.cl.
// hex_nodes: [tiles][8][16]. hex_data: mean gradients b_a [8][3] [1/m], then, UNIFORM, for all elements: gamma [4 modes][8 corners] [1],
// V [m^3], hourglass stiffness k [N/m] ([58]); else: 31 numbers of hex8_hourglass.cl, V [m^3] ([tiles][56][16]).
// node_w: increments of the last step, read with VISCOUS (viscous.cl).
// hex_fill: fill fraction per element (0 for padding). corner_force: [tiles][8 corners][3][16] from corner_base on [N].
#include "arith.cl"
#include "texels.cl"
#include "law.cl"
#include "viscous.cl"
#if UNIFORM
#define DATA(k) hex_data[k]
#define RECORD_TYPE float
#define VOLUME 56
#else
#include "hex8_hourglass.cl"
#define DATA(k) LOAD(data, (k)*PLIANT_TILE)
#define RECORD_TYPE real
#define VOLUME 55
#endif

__kernel void tled_hex8_force(__global const float* node_u, __global const int* hex_nodes, __global const float* hex_data,
                              __global const float* hex_fill, __global float* corner_force, __global int* fault,
                              __global const float* restrict law_parameters, __global const float* viscosity,
                              __global const float* node_w, __global const float* step_params, int corner_base, int fault_base, int step) {
  const int e = FIRST_INDEX;
  __global const int* nodes = hex_nodes + TILE_BASE(e, 8);
#if !UNIFORM
  __global const float* data = hex_data + TILE_BASE(e, PLIANT_HEX_DATA_PLANES);
#endif
  const law m = law_load(law_parameters);
  real x[8], y[8], z[8];
  for (int a = 0; a < 8; ++a) {
    const texels u = texels_gather(node_u, nodes + a * PLIANT_TILE);
    x[a] = texels_x(u);
    y[a] = texels_y(u);
    z[a] = texels_z(u);
  }
  mat3 h = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
#if !UNIFORM
// Without this, PoCL keeps the private arrays in memory, which takes 50 % longer. (No comment after a pragma: it would be ignored.)
#pragma unroll
#endif
  for (int a = 0; a < 8; ++a) {
    const RECORD_TYPE bx = DATA(3 * a), by = DATA(3 * a + 1), bz = DATA(3 * a + 2);
    h.m00 = fma(x[a], bx, h.m00);
    h.m01 = fma(x[a], by, h.m01);
    h.m02 = fma(x[a], bz, h.m02);
    h.m10 = fma(y[a], bx, h.m10);
    h.m11 = fma(y[a], by, h.m11);
    h.m12 = fma(y[a], bz, h.m12);
    h.m20 = fma(z[a], bx, h.m20);
    h.m21 = fma(z[a], by, h.m21);
    h.m22 = fma(z[a], bz, h.m22);
  }
  const deformation d = deformation_of(h);
  const real fill = LOAD(hex_fill, e);
  integer kind;
  mat3 p = stress_of(d, fill * DATA(VOLUME), m, law_pressure(m, d.j), fill > 0.0f, &kind);
#if VISCOUS
  mat3 w = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  for (int a = 0; a < 8; ++a) {
    const texels t = texels_gather(node_w, nodes + a * PLIANT_TILE);
    const RECORD_TYPE bx = DATA(3 * a), by = DATA(3 * a + 1), bz = DATA(3 * a + 2);
    ADD_CORNER(w, texels_x(t), texels_y(t), texels_z(t), bx, by, bz)
  }
  p = add_viscous(p, h, w, fill * DATA(VOLUME), viscosity, step_params);
#endif
  MARK_FAULT(kind, step, fault, fault_base + e)
#if UNIFORM
  const real k = fill * DATA(57);
  real qx[4], qy[4], qz[4];
  for (int i = 0; i < 4; ++i) {
    qx[i] = qy[i] = qz[i] = 0.0f;
    for (int a = 0; a < 8; ++a) {
      const RECORD_TYPE gamma = DATA(24 + 8 * i + a);
      qx[i] = fma(gamma, x[a], qx[i]);
      qy[i] = fma(gamma, y[a], qy[i]);
      qz[i] = fma(gamma, z[a], qz[i]);
    }
    qx[i] = k * qx[i];
    qy[i] = k * qy[i];
    qz[i] = k * qz[i];
  }
#else
  const modes qx = modes_of(x), qy = modes_of(y), qz = modes_of(z);
  vec3 q[4] = {{qx.xy, qy.xy, qz.xy}, {qx.xz, qy.xz, qz.xz}, {qx.yz, qy.yz, qz.yz}, {qx.xyz, qy.xyz, qz.xyz}};
  p = hourglass(q, h, p, fill, data);
  modes_back((modes){q[0].x, q[1].x, q[2].x, q[3].x}, x);  // forces from here on
  modes_back((modes){q[0].y, q[1].y, q[2].y, q[3].y}, y);
  modes_back((modes){q[0].z, q[1].z, q[2].z, q[3].z}, z);
#endif
  __global float* out = corner_force + corner_base + TILE_BASE(e, PLIANT_HEX_FORCE_PLANES);
#if !UNIFORM
#pragma unroll
#endif
  for (int a = 0; a < 8; ++a) {
    const RECORD_TYPE bx = DATA(3 * a), by = DATA(3 * a + 1), bz = DATA(3 * a + 2);
#if UNIFORM
    real fx = fma(p.m02, bz, fma(p.m01, by, p.m00 * bx));
    real fy = fma(p.m12, bz, fma(p.m11, by, p.m10 * bx));
    real fz = fma(p.m22, bz, fma(p.m21, by, p.m20 * bx));
    for (int i = 0; i < 4; ++i) {
      const RECORD_TYPE gamma = DATA(24 + 8 * i + a);
      fx = fma(gamma, qx[i], fx);
      fy = fma(gamma, qy[i], fy);
      fz = fma(gamma, qz[i], fz);
    }
#else
    const real fx = fma(p.m02, bz, fma(p.m01, by, fma(p.m00, bx, x[a])));
    const real fy = fma(p.m12, bz, fma(p.m11, by, fma(p.m10, bx, y[a])));
    const real fz = fma(p.m22, bz, fma(p.m21, by, fma(p.m20, bx, z[a])));
#endif
    STORE(fx, out, (3 * a) * PLIANT_TILE);
    STORE(fy, out, (3 * a + 1) * PLIANT_TILE);
    STORE(fz, out, (3 * a + 2) * PLIANT_TILE);
  }
}
