// Corner forces of linear tetrahedra: f_a = V P grad N_a (total Lagrangian, one point; Miller et al. 2007;
// Hybrid Deformation Model, equations 10 to 13).
// tet_nodes: [tiles][4][16] node indices. tet_data: [tiles][10][16] grad N_1..3 [1/m], V [m^3]; grad N_0 is minus their sum.
// corner_force: [tiles][4 corners][3][16] from corner_base on [N]. fault: step of the first fault per element, from fault_base on.
// node_w: increments of the last step, read with VISCOUS (viscous.cl).
// AVERAGED: the volumetric stress is the mean of the four nodal pressures (tet4anp) instead of dU/dJ.
#include "arith.cl"
#include "texels.cl"
#include "law.cl"
#include "viscous.cl"
#include "tet4.cl"

__kernel void tled_tet4_force(__global const float* node_u, __global const int* tet_nodes, __global const float* tet_data,
                              __global const float* anp_pressure, __global float* corner_force, __global int* fault,
                              __global const float* restrict law_parameters, __global const float* viscosity,
                              __global const float* node_w, __global const float* step_params, int corner_base, int fault_base, int step) {
  const int e = FIRST_INDEX;
  const law m = law_load(law_parameters);
  __global const int* nodes = tet_nodes + TILE_BASE(e, 4);
  __global const float* data = tet_data + TILE_BASE(e, PLIANT_TET_DATA_PLANES);
#if AVERAGED
  const real pressure = 0.25f * ((gather(anp_pressure, nodes) + gather(anp_pressure, nodes + PLIANT_TILE)) +
                                 (gather(anp_pressure, nodes + 2 * PLIANT_TILE) + gather(anp_pressure, nodes + 3 * PLIANT_TILE)));
#endif
  const tet4 t = tet4_load(node_u, nodes, data);
  const deformation d = deformation_of(t.h);
#if !AVERAGED
  const real pressure = law_pressure(m, d.j);
#endif
  const integer all = -1;
  integer kind;
  mat3 p = stress_of(d, DATA(9), m, pressure, all, &kind);
#if VISCOUS
  p = add_viscous(p, t.h, tet4_load(node_w, nodes, data).h, DATA(9), viscosity, step_params);
#endif
  MARK_FAULT(kind, step, fault, fault_base + e)
  const real f1x = fma(p.m02, t.b1z, fma(p.m01, t.b1y, p.m00 * t.b1x));
  const real f1y = fma(p.m12, t.b1z, fma(p.m11, t.b1y, p.m10 * t.b1x));
  const real f1z = fma(p.m22, t.b1z, fma(p.m21, t.b1y, p.m20 * t.b1x));
  const real f2x = fma(p.m02, t.b2z, fma(p.m01, t.b2y, p.m00 * t.b2x));
  const real f2y = fma(p.m12, t.b2z, fma(p.m11, t.b2y, p.m10 * t.b2x));
  const real f2z = fma(p.m22, t.b2z, fma(p.m21, t.b2y, p.m20 * t.b2x));
  const real f3x = fma(p.m02, t.b3z, fma(p.m01, t.b3y, p.m00 * t.b3x));
  const real f3y = fma(p.m12, t.b3z, fma(p.m11, t.b3y, p.m10 * t.b3x));
  const real f3z = fma(p.m22, t.b3z, fma(p.m21, t.b3y, p.m20 * t.b3x));
  __global float* out = corner_force + corner_base + TILE_BASE(e, PLIANT_TET_FORCE_PLANES);
#define PUT(plane, value) STORE(value, out, (plane)*PLIANT_TILE)
  PUT(0, -((f1x + f2x) + f3x));
  PUT(1, -((f1y + f2y) + f3y));
  PUT(2, -((f1z + f2z) + f3z));
  PUT(3, f1x);
  PUT(4, f1y);
  PUT(5, f1z);
  PUT(6, f2x);
  PUT(7, f2y);
  PUT(8, f2z);
  PUT(9, f3x);
  PUT(10, f3y);
  PUT(11, f3z);
}
