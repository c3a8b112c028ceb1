// Third pass from nodes to regions: sums of plates along z links and the nodes that no such path reaches; then the region's rigid
// transformation T (the source's equations 1 to 5).
//
// With weights m (in units that make the moments plain numbers), d the centroid at rest minus the centre of the window in cells, and o the
// grid offset of a node from the centre: A = sum m (x - c) (X - C)^T = A_0 + sum m u o^T - (sum m u) d^T, R its rotation,
// T X = X + t + h D o with D = R - I and t = sum m u / sum m - h D d.
// flsm_plates: [regions][4] blocks. flsm_link: [regions][2] at -z, +z. missing_offset: [regions + 1]; missing: [entries] slots;
// missing_factor: [entries] blocks. flsm_rest: [tiles][10][16] 1 / sum m, d (3) [cells], A_0 (xx yy zz xy xz yz).
// flsm_regions: [regions][4] blocks: t, h D e_x, h D e_y, h D e_z [m]; on entry those of the step before, kept where A vanishes.
#include "arith.cl"
#include "texels.cl"
#include "deformation.cl"
#include "flsm_rotation.cl"
#include "flsm_records.cl"

#define REST(plane) LOAD(rest, (plane)*PLIANT_TILE)

__kernel void flsm_region(__global const float* node_u, __global const float* flsm_plates, __global const int* flsm_link,
                          __global const int* missing_offset, __global const int* missing,
                          __global const float* missing_factor, __global const float* flsm_rest, __global float* flsm_regions,
                          float spacing) {
  const int first = FIRST_INDEX;
  float moments[LANES * PLIANT_FLSM_RECORD];
  for (int l = 0; l < LANES; ++l) {
    const int i = first + l;
    float16 sum = vload16(i, flsm_plates);
    float4 moment = 0.0f;
    int below = i, above = i;
    for (int o = 1; o <= WIDTH; ++o) {
      below = flsm_link[2 * below];
      above = flsm_link[2 * above + 1];
      const float16 at_below = vload16(below, flsm_plates), at_above = vload16(above, flsm_plates);
      sum = (sum + at_below) + at_above;
      moment = fma((float4)((float)o), at_above.lo.lo - at_below.lo.lo, moment);
    }
    sum = (float16)(sum.lo, sum.hi.lo, moment);
    const int first_entry = missing_offset[i], last_entry = missing_offset[i + 1];
    if (first_entry < last_entry) {
      float16 listed = -0.0f;
      for (int e = first_entry; e < last_entry; ++e) {
        const float4 u = vload4(missing[e], node_u);
        listed = add_entry(missing_factor, e, (float16)(u, u, u, u), listed);
      }
      sum = sum + listed;
    }
    vstore16(sum, l, moments);
  }
  __global const float* rest = flsm_rest + TILE_BASE(first, PLIANT_FLSM_REST_PLANES);
  const texels s = records_block(moments, 0), sx = records_block(moments, 1), sy = records_block(moments, 2), sz = records_block(moments, 3);
  const real ux = texels_x(s), uy = texels_y(s), uz = texels_z(s);
  const real inverse = REST(0), dx = REST(1), dy = REST(2), dz = REST(3);
  const mat3 e = {fma(-ux, dx, texels_x(sx)), fma(-ux, dy, texels_x(sy)), fma(-ux, dz, texels_x(sz)),
                  fma(-uy, dx, texels_y(sx)), fma(-uy, dy, texels_y(sy)), fma(-uy, dz, texels_y(sz)),
                  fma(-uz, dx, texels_z(sx)), fma(-uz, dy, texels_z(sy)), fma(-uz, dz, texels_z(sz))};
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
