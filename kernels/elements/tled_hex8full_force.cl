// Corner forces of 8-node hexahedra with 2 x 2 x 2 Gauss points: f_a = fill sum_g w_g P_g grad N_a(g).
// hex_data, one record of 200 numbers: for each point g = 0..7, grad N_a [8 corners][3] [1/m] and then the weight w_g [m^3].
// UNIFORM: one record for all elements, otherwise [tiles][200][16]. Other arguments as in tled_hex8_force.
#include "arith.cl"
#include "texels.cl"
#include "law.cl"
#include "viscous.cl"
#if UNIFORM
#define DATA(k) hex_data[k]
#define RECORD_TYPE float
#else
#define DATA(k) LOAD(data, (k)*PLIANT_TILE)
#define RECORD_TYPE real
#endif

__kernel void tled_hex8full_force(__global const float* node_u, __global const int* hex_nodes, __global const float* hex_data,
                                  __global const float* hex_fill, __global float* corner_force, __global int* fault,
                                  __global const float* restrict law_parameters, __global const float* viscosity,
                                  __global const float* node_w, __global const float* step_params, int corner_base, int fault_base, int step) {
  const int e = FIRST_INDEX;
  const law m = law_load(law_parameters);
  __global const int* nodes = hex_nodes + TILE_BASE(e, 8);
#if !UNIFORM
  __global const float* data = hex_data + TILE_BASE(e, PLIANT_HEXFULL_DATA_PLANES);
#endif
  real x[8], y[8], z[8], fx[8], fy[8], fz[8];
  for (int a = 0; a < 8; ++a) {
    const texels u = texels_gather(node_u, nodes + a * PLIANT_TILE);
    x[a] = texels_x(u);
    y[a] = texels_y(u);
    z[a] = texels_z(u);
    fx[a] = fy[a] = fz[a] = 0.0f;
  }
#if VISCOUS
  real wx[8], wy[8], wz[8];
  for (int a = 0; a < 8; ++a) {
    const texels t = texels_gather(node_w, nodes + a * PLIANT_TILE);
    wx[a] = texels_x(t);
    wy[a] = texels_y(t);
    wz[a] = texels_z(t);
  }
#endif
  const real fill = LOAD(hex_fill, e);
  const integer none = NO_FAULT;
  integer kind = none;
  for (int g = 0; g < 8; ++g) {
    mat3 h = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    for (int a = 0; a < 8; ++a) {
      const RECORD_TYPE bx = DATA(25 * g + 3 * a), by = DATA(25 * g + 3 * a + 1), bz = DATA(25 * g + 3 * a + 2);
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
    integer found;
    mat3 p = stress_of(d, fill * DATA(25 * g + 24), m, law_pressure(m, d.j), fill > 0.0f, &found);
    kind = found > kind ? found : kind;
#if VISCOUS
    mat3 w = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    for (int a = 0; a < 8; ++a) {
      const RECORD_TYPE bx = DATA(25 * g + 3 * a), by = DATA(25 * g + 3 * a + 1), bz = DATA(25 * g + 3 * a + 2);
      ADD_CORNER(w, wx[a], wy[a], wz[a], bx, by, bz)
    }
    p = add_viscous(p, h, w, fill * DATA(25 * g + 24), viscosity, step_params);
#endif
    for (int a = 0; a < 8; ++a) {
      const RECORD_TYPE bx = DATA(25 * g + 3 * a), by = DATA(25 * g + 3 * a + 1), bz = DATA(25 * g + 3 * a + 2);
      fx[a] = fma(p.m02, bz, fma(p.m01, by, fma(p.m00, bx, fx[a])));
      fy[a] = fma(p.m12, bz, fma(p.m11, by, fma(p.m10, bx, fy[a])));
      fz[a] = fma(p.m22, bz, fma(p.m21, by, fma(p.m20, bx, fz[a])));
    }
  }
  MARK_FAULT(kind, step, fault, fault_base + e)
  __global float* out = corner_force + corner_base + TILE_BASE(e, PLIANT_HEX_FORCE_PLANES);
  for (int a = 0; a < 8; ++a) {
    STORE(fx[a], out, (3 * a) * PLIANT_TILE);
    STORE(fy[a], out, (3 * a + 1) * PLIANT_TILE);
    STORE(fz[a], out, (3 * a + 2) * PLIANT_TILE);
  }
}
