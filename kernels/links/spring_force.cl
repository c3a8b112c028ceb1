// Forces of springs between two points of links: f = F(e) d / |d|, where d = D + u_b - u_a, D the difference at rest and e = |d| - l0 the elongation,
// which is computed from |d|^2 - l0^2 = (u_b - u_a) . (D + d) + (|D|^2 - l0^2), so that small elongations of long springs lose nothing.
// spring_points: [tiles][2][16] points a, b. spring_data: [tiles][8][16] D (3) [m], l0 [m], |D|^2 - l0^2 [m^2], two parameters of the law, damper [N s/m].
// link_force: [tiles][3][16] from force_base on, the force on a; that on b is the opposite [N]. LAW (scene/spring.h): the two parameters are
//   0 linear: -, k [N/m];  F = k e
//   1 cubic: lambda1 / l0^3, lambda2 / l0;  F = lambda1 (e / l0)^3 + lambda2 e / l0
//   2 measured: a [1/N], b [m/N];  F = e / (a |e| + b), with a < 0 continued along its tangent from 3/4 of the way to where it is infinite
//   3 curve: -, factor [1];  F = factor times a polygon through pairs (e, F). spring_curve: [segments][3] e [m], F [N] and slope of each.
// VISCOUS: the damper adds to F its constant times the rate of |d| over the last step. SLACK: no force unless e > 0, and none that pushes.
#include "arith.cl"
#include "texels.cl"

#define DATA(k) LOAD(data, (k)*PLIANT_TILE)

static inline real law_force(real e, real first, real second, __global const float* spring_curve, int segments) {
#if LAW == 1
  return fma(first * e, e, second) * e;
#elif LAW == 2
  const real size = fabs(e), far = 1e30f;
  const real limit = first < 0.0f ? (-0.75f * second) / first : far;
  const real most = size < limit ? size : limit;
  const real inverse = 1.0f / fma(first, most, second);
  const real force = fma((second * inverse) * inverse, size - most, most * inverse);
  return e < 0.0f ? -force : force;
#elif LAW == 3
  real force = fma((real)spring_curve[2], e - spring_curve[0], (real)spring_curve[1]);
  for (int k = 1; k < segments; ++k) {
    __global const float* s = spring_curve + 3 * k;
    const real here = fma((real)s[2], e - s[0], (real)s[1]);
    force = e >= s[0] ? here : force;
  }
  return second * force;
#else
  return second * e;
#endif
}

__kernel void spring_force(__global const float* link_u, __global const float* link_w, __global const int* spring_points,
                           __global const float* spring_data, __global const float* spring_curve, __global float* link_force,
                           __global const float* step_params, int segments, int force_base) {
  const int i = FIRST_INDEX;
  __global const int* points = spring_points + TILE_BASE(i, 2);
  __global const float* data = spring_data + TILE_BASE(i, PLIANT_SPRING_PLANES);
  const texels ua = texels_gather(link_u, points), ub = texels_gather(link_u, points + PLIANT_TILE);
  const real ux = texels_x(ub) - texels_x(ua), uy = texels_y(ub) - texels_y(ua), uz = texels_z(ub) - texels_z(ua);
  const real x = DATA(0), y = DATA(1), z = DATA(2), none = 0.0f;
  const real dx = x + ux, dy = y + uy, dz = z + uz;
  const real length = sqrt(fma(dz, dz, fma(dy, dy, dx * dx)));
  const real squares = fma(uz, z + dz, fma(uy, y + dy, ux * (x + dx))) + DATA(4);
  const real both = length + DATA(3);
  const real e = both > 0.0f ? squares / both : none;  // neither has a length: two nodes at one place
  const real inverse = length > 0.0f ? 1.0f / length : none;
  real force = law_force(e, DATA(5), DATA(6), spring_curve, segments);
#if VISCOUS
  const texels wa = texels_gather(link_w, points), wb = texels_gather(link_w, points + PLIANT_TILE);
  const real wx = texels_x(wb) - texels_x(wa), wy = texels_y(wb) - texels_y(wa), wz = texels_z(wb) - texels_z(wa);
  const real rate = (fma(wz, dz, fma(wy, dy, wx * dx)) * inverse) / step_params[0];
  force = fma(DATA(7), rate, force);
#endif
#if SLACK
  force = e > 0.0f && force > 0.0f ? force : none;
#endif
  const real scale = force * inverse;
  __global float* out = link_force + force_base + TILE_BASE(i, 3);
  STORE(scale * dx, out, 0);
  STORE(scale * dy, out, PLIANT_TILE);
  STORE(scale * dz, out, 2 * PLIANT_TILE);
}
