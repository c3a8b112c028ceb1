// Third pass from nodes to regions: sums of plates along z links and the nodes that no such path reaches; then the region's rigid
// transformation T (Hybrid Deformation Model, equations 1 to 5; Rivers and James 2007).
//
// With weights m (in units that make the moments plain numbers), d the centroid at rest minus the centre of the window in cells, and o the
// grid offset of a node from the centre: A = sum m (x - c) (X - C)^T = A_0 + sum m u o^T - (sum m u) d^T, R its rotation,
// T X = X + t + h D o with D = R - I and t = sum m u / sum m - h D d.
// flsm_plates: [regions][4] blocks. flsm_link: [regions][2] at -z, +z. missing_offset: [regions + 1]; missing: [entries] slots;
// missing_factor: [entries] blocks. flsm_reference as in flsm_bar. flsm_rest: [tiles][10][16] 1 / sum m, d (3) [cells], A_0 (xx yy zz xy xz yz).
// flsm_regions: [regions][4] blocks: t, h D e_x, h D e_y, h D e_z [m]; on entry those of the step before, kept where A vanishes.
#include "arith.cl"
#include "texels.cl"
#include "deformation.cl"
#include "flsm_rotation.cl"
#include "flsm_records.cl"
#include "flsm_moments.cl"

#define REST(plane) LOAD(rest, (plane)*PLIANT_TILE)

__kernel void flsm_region(__global const float* node_u, __global const float* flsm_plates, __global const int* flsm_link,
                          __global const int* missing_offset, __global const int* missing,
                          __global const float* missing_factor, __global const float* flsm_reference, __global const float* flsm_rest, __global float* flsm_regions,
                          float spacing) {
  const int first = FIRST_INDEX;
  float moments[LANES * PLIANT_FLSM_RECORD];
  for (int l = 0; l < LANES; ++l) {
    vstore16(region_moments(node_u, flsm_plates, flsm_link, missing_offset, missing, missing_factor, vload4(0, flsm_reference), first + l), l, moments);
  }
  __global const float* rest = flsm_rest + TILE_BASE(first, PLIANT_FLSM_REST_PLANES);
  const real inverse = REST(0), dx = REST(1), dy = REST(2), dz = REST(3);
  real ux, uy, uz;
  const mat3 e = central_moments(moments, dx, dy, dz, &ux, &uy, &uz);
  const real axx = REST(4), ayy = REST(5), azz = REST(6);
  integer ok;
  const mat3 d = rotation_of(axx, ayy, azz, REST(7), REST(8), REST(9), e, (axx + ayy) + azz, &ok);
  const real h = spacing, none = 0.0f;
  real xx = h * d.m00, xy = h * d.m01, xz = h * d.m02, yx = h * d.m10, yy = h * d.m11, yz = h * d.m12, zx = h * d.m20, zy = h * d.m21,
       zz = h * d.m22;
  if (ANY(!ok)) {
    const texels x = records_load(flsm_regions, first, 1), y = records_load(flsm_regions, first, 2), z = records_load(flsm_regions, first, 3);
    xx = ok ? xx : texels_x(x), yx = ok ? yx : texels_y(x), zx = ok ? zx : texels_z(x);
    xy = ok ? xy : texels_x(y), yy = ok ? yy : texels_y(y), zy = ok ? zy : texels_z(y);
    xz = ok ? xz : texels_x(z), yz = ok ? yz : texels_y(z), zz = ok ? zz : texels_z(z);
  }
  const real tx = fma(-xz, dz, fma(-xy, dy, fma(-xx, dx, inverse * ux)));
  const real ty = fma(-yz, dz, fma(-yy, dy, fma(-yx, dx, inverse * uy)));
  const real tz = fma(-zz, dz, fma(-zy, dy, fma(-zx, dx, inverse * uz)));
  records_store(tx, ty, tz, none, flsm_regions, first, 0);
  records_store(xx, yx, zx, none, flsm_regions, first, 1);
  records_store(xy, yy, zy, none, flsm_regions, first, 2);
  records_store(xz, yz, zz, none, flsm_regions, first, 3);
}
