// Third pass from nodes to regions: sums of plates along z links and the nodes that no such path reaches; then the region's rigid transformation T
// (Hybrid Deformation Model, equations 1 to 5; Rivers and James 2007).
//
// With weights m (in units that make the moments plain numbers), d the undeformed centroid minus the centre of the window in cells, and o the grid
// offset of a node from the centre: A = sum m (x - c) (X - C)^T = A_0 + sum m u o^T - (sum m u) d^T, R its rotation, T X = X + t + h D o with D = R -
// I and t = sum m u / sum m - h D d. flsm_plates: [regions][4] blocks. flsm_link: [regions][2] at -z, +z. missing_offset: [regions + 1]; missing:
// [entries] slots; missing_factor: [entries] blocks. flsm_reference as in flsm_bar. flsm_rest: [tiles][10][16] 1 / sum m, d (3) [cells], A_0 (xx yy
// zz xy xz yz). flsm_regions: [regions][4] blocks: t, h D e_x, h D e_y, h D e_z [m]; contains the previous values on entry, which are kept where A
// vanishes.
//
// ELASTIC: the region deforms like a material (host/model/matching/flsm_elastic.cpp). With H = F - I of its best affine fit, D becomes
//   H - q P M,  P = corotated_stress(H, D),  M the inverse of the moments, q the second moment of the material.
// flsm_elastic: [tiles][7][16] M (xx yy zz xy xz yz), q. flsm_rest then holds the identity for A_0; where q = 0 it holds A_0, M is the identity, and
// the region is rigid. flsm_pulls: [regions][4] blocks as flsm_regions, which keep the rigid motion. Neither buffer is used without ELASTIC.
#include "arith.cl"
#include "texels.cl"
#include "deformation.cl"
#include "flsm_rotation.cl"
#include "flsm_records.cl"
#include "flsm_moments.cl"

#define REST(plane) LOAD(rest, (plane)*PLIANT_TILE)
#define SOFT(plane) LOAD(soft, (plane)*PLIANT_TILE)

// a m for a symmetric m (xx yy zz xy xz yz).
static inline mat3 times_symmetric(mat3 a, real xx, real yy, real zz, real xy, real xz, real yz) {
  const mat3 p = {fma(a.m02, xz, fma(a.m01, xy, a.m00 * xx)), fma(a.m02, yz, fma(a.m01, yy, a.m00 * xy)), fma(a.m02, zz, fma(a.m01, yz, a.m00 * xz)),
                  fma(a.m12, xz, fma(a.m11, xy, a.m10 * xx)), fma(a.m12, yz, fma(a.m11, yy, a.m10 * xy)), fma(a.m12, zz, fma(a.m11, yz, a.m10 * xz)),
                  fma(a.m22, xz, fma(a.m21, xy, a.m20 * xx)), fma(a.m22, yz, fma(a.m21, yy, a.m20 * xy)), fma(a.m22, zz, fma(a.m21, yz, a.m20 * xz))};
  return p;
}

// First Piola-Kirchhoff stress P of the deformation H with the rotation I + D: R (shear (s - s^2 / 2 + s^3 / 8) + bulk tr s), with the symmetric s =
// R^T (H - D); softer at large s (host/model/matching/flsm_elastic.cpp).
static inline mat3 corotated_stress(mat3 h, mat3 d, real shear, real bulk) {
  const mat3 r = {h.m00 - d.m00, h.m01 - d.m01, h.m02 - d.m02, h.m10 - d.m10, h.m11 - d.m11, h.m12 - d.m12, h.m20 - d.m20, h.m21 - d.m21, h.m22 - d.m22};
  const real xx = fma(d.m20, r.m20, fma(d.m10, r.m10, fma(d.m00, r.m00, r.m00))), xy = fma(d.m20, r.m21, fma(d.m10, r.m11, fma(d.m00, r.m01, r.m01)));
  const real xz = fma(d.m20, r.m22, fma(d.m10, r.m12, fma(d.m00, r.m02, r.m02))), yy = fma(d.m21, r.m21, fma(d.m11, r.m11, fma(d.m01, r.m01, r.m11)));
  const real yz = fma(d.m21, r.m22, fma(d.m11, r.m12, fma(d.m01, r.m02, r.m12))), zz = fma(d.m22, r.m22, fma(d.m12, r.m12, fma(d.m02, r.m02, r.m22)));
  const mat3 s = {xx, xy, xz, xy, yy, yz, xz, yz, zz};
  const real second = 0.5f, eighth = 0.125f, one = 1.0f, two = 2.0f, four = 4.0f, sixth = 1.0f / 6.0f, sixteenth = 0.0625f;
  const mat3 square = times_symmetric(s, xx, yy, zz, xy, xz, yz);
  // Beyond |s|^2 = most the terms of s^3 and s^4 in psi shrink by k and k^2, k = y (2 - y), y = most / |s|^2.
  const real most = PLIANT_FLSM_STRAIN;
  const real tr2 = (square.m00 + square.m11) + square.m22;
  const real tr3 = fma(two, fma(square.m12, yz, fma(square.m02, xz, square.m01 * xy)), fma(square.m22, zz, fma(square.m11, yy, square.m00 * xx)));
  const real tr4 = fma(two, fma(square.m12, square.m12, fma(square.m02, square.m02, square.m01 * square.m01)),
                       fma(square.m22, square.m22, fma(square.m11, square.m11, square.m00 * square.m00)));
  const real y = tr2 > most ? most / tr2 : one, k = y * (two - y);
  const real own = fma(((four * (y - one)) * (y * y)) / most, fma(k * sixteenth, tr4, -sixth * tr3), one);
  const real linear = -second * k, quadratic = eighth * (k * k);
  // own - k s / 2 + k^2 s^2 / 8, times s.
  const mat3 factor = {fma(quadratic, square.m00, fma(linear, xx, own)), fma(quadratic, square.m01, linear * xy), fma(quadratic, square.m02, linear * xz),
                       fma(quadratic, square.m10, linear * xy), fma(quadratic, square.m11, fma(linear, yy, own)), fma(quadratic, square.m12, linear * yz),
                       fma(quadratic, square.m20, linear * xz), fma(quadratic, square.m21, linear * yz), fma(quadratic, square.m22, fma(linear, zz, own))};
  const mat3 f = times_symmetric(factor, xx, yy, zz, xy, xz, yz);
  const real p = bulk * ((xx + yy) + zz);
  const real fxx = fma(shear, f.m00, p), fyy = fma(shear, f.m11, p), fzz = fma(shear, f.m22, p), fxy = shear * f.m01, fxz = shear * f.m02, fyz = shear * f.m12;
  const mat3 turned = times_symmetric(d, fxx, fyy, fzz, fxy, fxz, fyz);
  const mat3 stress = {fxx + turned.m00, fxy + turned.m01, fxz + turned.m02, fxy + turned.m10, fyy + turned.m11, fyz + turned.m12,
                       fxz + turned.m20, fyz + turned.m21, fzz + turned.m22};
  return stress;
}

__kernel void flsm_region(__global const float* node_u, __global const float* flsm_plates, __global const int* flsm_link,
                          __global const int* missing_offset, __global const int* missing,
                          __global const float* missing_factor, __global const float* flsm_reference, __global const float* flsm_rest, __global float* flsm_regions,
                          __global const float* flsm_elastic, __global float* flsm_pulls, float spacing, float shear, float bulk) {
  const int first = FIRST_INDEX;
  float moments[LANES * PLIANT_FLSM_RECORD];
  for (int l = 0; l < LANES; ++l) {
    vstore16(region_moments(node_u, flsm_plates, flsm_link, missing_offset, missing, missing_factor, BLOCK4(flsm_reference, 0), first + l), l, moments);
  }
  __global const float* rest = flsm_rest + TILE_BASE(first, PLIANT_FLSM_REST_PLANES);
  const real inverse = REST(0), dx = REST(1), dy = REST(2), dz = REST(3);
  real ux, uy, uz;
#if ELASTIC
  __global const float* soft = flsm_elastic + TILE_BASE(first, PLIANT_FLSM_ELASTIC_PLANES);
  const mat3 e = times_symmetric(central_moments(moments, dx, dy, dz, &ux, &uy, &uz), SOFT(0), SOFT(1), SOFT(2), SOFT(3), SOFT(4), SOFT(5));
#else
  const mat3 e = central_moments(moments, dx, dy, dz, &ux, &uy, &uz);
#endif
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
#if ELASTIC
  const real q = SOFT(6), pull = q * h;
  const mat3 p = times_symmetric(corotated_stress(e, d, (real)shear, (real)bulk), SOFT(0), SOFT(1), SOFT(2), SOFT(3), SOFT(4), SOFT(5));
  const integer gives = ok && q > 0.0f;
  xx = gives ? fma(-pull, p.m00, h * e.m00) : xx, xy = gives ? fma(-pull, p.m01, h * e.m01) : xy, xz = gives ? fma(-pull, p.m02, h * e.m02) : xz;
  yx = gives ? fma(-pull, p.m10, h * e.m10) : yx, yy = gives ? fma(-pull, p.m11, h * e.m11) : yy, yz = gives ? fma(-pull, p.m12, h * e.m12) : yz;
  zx = gives ? fma(-pull, p.m20, h * e.m20) : zx, zy = gives ? fma(-pull, p.m21, h * e.m21) : zy, zz = gives ? fma(-pull, p.m22, h * e.m22) : zz;
  records_store(fma(-xz, dz, fma(-xy, dy, fma(-xx, dx, inverse * ux))), fma(-yz, dz, fma(-yy, dy, fma(-yx, dx, inverse * uy))),
                fma(-zz, dz, fma(-zy, dy, fma(-zx, dx, inverse * uz))), none, flsm_pulls, first, 0);
  records_store(xx, yx, zx, none, flsm_pulls, first, 1);
  records_store(xy, yy, zy, none, flsm_pulls, first, 2);
  records_store(xz, yz, zz, none, flsm_pulls, first, 3);
#endif
}
