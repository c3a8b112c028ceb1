// Per-region damping, third pass from nodes to regions (Rivers and James 2007, section 5.2): the rigid motion closest to the increments w of a
// region's nodes. flsm_plates holds their sums. In the undeformed frame of the region, with its rotation R and r = X - C in cells,
//   v = sum m w / sum m,  spin = I^-1 sum m r x (R^T w),  w_rigid = v + R (spin x r).
// Arguments as in flsm_region, but node_w for node_u. flsm_spin: [tiles][6][16] I^-1 (xx yy zz xy xz yz) [m]. inverse_spacing [1/m]. flsm_rates:
// [regions][4] blocks: w_rigid at the centre of the window, and its change per cell along x, y and z [m].
#include "arith.cl"
#include "texels.cl"
#include "deformation.cl"
#include "flsm_records.cl"
#include "flsm_moments.cl"

#define REST(plane) LOAD(rest, (plane)*PLIANT_TILE)
#define SPIN(plane) LOAD(spin, (plane)*PLIANT_TILE)

static inline real dot3(real ax, real bx, real ay, real by, real az, real bz) { return fma(az, bz, fma(ay, by, ax * bx)); }

__kernel void flsm_damp_region(__global const float* node_w, __global const float* flsm_plates, __global const int* flsm_link,
                               __global const int* missing_offset, __global const int* missing,
                               __global const float* missing_factor, __global const float* flsm_rest,
                               __global const float* flsm_spin, __global const float* flsm_regions, __global float* flsm_rates,
                               float inverse_spacing) {
  const int first = FIRST_INDEX;
  float moments[LANES * PLIANT_FLSM_RECORD];
  for (int l = 0; l < LANES; ++l) {
    vstore16(region_moments(node_w, flsm_plates, flsm_link, missing_offset, missing, missing_factor, (float4)(0.0f), first + l), l, moments);
  }
  __global const float* rest = flsm_rest + TILE_BASE(first, PLIANT_FLSM_REST_PLANES);
  __global const float* spin = flsm_spin + TILE_BASE(first, PLIANT_FLSM_SPIN_PLANES);
  const real inverse = REST(0), dx = REST(1), dy = REST(2), dz = REST(3), none = 0.0f, one = 1.0f, scale = inverse_spacing;
  real sx, sy, sz;
  const mat3 b = central_moments(moments, dx, dy, dz, &sx, &sy, &sz);
  const texels cx = records_load(flsm_regions, first, 1), cy = records_load(flsm_regions, first, 2), cz = records_load(flsm_regions, first, 3);
  const mat3 r = {fma(texels_x(cx), scale, one),  fma(texels_x(cy), scale, none), fma(texels_x(cz), scale, none),
                  fma(texels_y(cx), scale, none), fma(texels_y(cy), scale, one),  fma(texels_y(cz), scale, none),
                  fma(texels_z(cx), scale, none), fma(texels_z(cy), scale, none), fma(texels_z(cz), scale, one)};
  // Angular momentum in the undeformed frame: the antisymmetric part of R^T B.
  const real lx = dot3(r.m02, b.m01, r.m12, b.m11, r.m22, b.m21) - dot3(r.m01, b.m02, r.m11, b.m12, r.m21, b.m22);
  const real ly = dot3(r.m00, b.m02, r.m10, b.m12, r.m20, b.m22) - dot3(r.m02, b.m00, r.m12, b.m10, r.m22, b.m20);
  const real lz = dot3(r.m01, b.m00, r.m11, b.m10, r.m21, b.m20) - dot3(r.m00, b.m01, r.m10, b.m11, r.m20, b.m21);
  const real wx = dot3(SPIN(0), lx, SPIN(3), ly, SPIN(4), lz);
  const real wy = dot3(SPIN(3), lx, SPIN(1), ly, SPIN(5), lz);
  const real wz = dot3(SPIN(4), lx, SPIN(5), ly, SPIN(2), lz);
  // Columns R (spin x e).
  const real xx = fma(r.m01, wz, -(r.m02 * wy)), xy = fma(r.m11, wz, -(r.m12 * wy)), xz = fma(r.m21, wz, -(r.m22 * wy));
  const real yx = fma(r.m02, wx, -(r.m00 * wz)), yy = fma(r.m12, wx, -(r.m10 * wz)), yz = fma(r.m22, wx, -(r.m20 * wz));
  const real zx = fma(r.m00, wy, -(r.m01 * wx)), zy = fma(r.m10, wy, -(r.m11 * wx)), zz = fma(r.m20, wy, -(r.m21 * wx));
  records_store(fma(-zx, dz, fma(-yx, dy, fma(-xx, dx, inverse * sx))), fma(-zy, dz, fma(-yy, dy, fma(-xy, dx, inverse * sy))),
                fma(-zz, dz, fma(-yz, dy, fma(-xz, dx, inverse * sz))), none, flsm_rates, first, 0);
  records_store(xx, xy, xz, none, flsm_rates, first, 1);
  records_store(yx, yy, yz, none, flsm_rates, first, 2);
  records_store(zx, zy, zz, none, flsm_rates, first, 3);
}
