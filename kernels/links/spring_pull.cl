// Force of a spring over its length, F(e) / |d|: d = D + u, D the difference between its ends at rest, u that of their displacements, and e = |d| - l0 the
// elongation, which is computed from |d|^2 - l0^2 = u . (D + d) + (|D|^2 - l0^2), so that small elongations of long springs lose nothing.
// LAW (scene/spring.h): what `first` and `second` are
//   0 linear: -, k [N/m];  F = k e
//   1 cubic: lambda1 / l0^3, lambda2 / l0;  F = lambda1 (e / l0)^3 + lambda2 e / l0
//   2 measured: a [1/N], b [m/N];  F = e / (a |e| + b), with a < 0 continued along its tangent from 3/4 of the way to where it is infinite
//   3 curve: -, factor [1];  F = factor times a polygon through pairs (e, F). spring_curve: [segments][3] e [m], F [N] and slope of each.
// VISCOUS: the damper adds to F its constant times the rate of |d| over the last step. SLACK: no force unless e > 0, and none that pushes.

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

// x y z: D [m]. ux uy uz: u [m]. squares: |D|^2 - l0^2 [m^2]. wx wy wz: difference of the last increments [m]. damper [N s/m]. dt: the step [s]. Returns
// F / |d| [N/m], and d in dx dy dz.
INLINE real spring_pull(real x, real y, real z, real ux, real uy, real uz, real l0, real squares, real first, real second,
                        __global const float* spring_curve, int segments, real wx, real wy, real wz, real damper, float dt, real* dx, real* dy,
                        real* dz) {
  const real none = 0.0f;
  *dx = x + ux;
  *dy = y + uy;
  *dz = z + uz;
  const real length = sqrt(fma(*dz, *dz, fma(*dy, *dy, *dx * *dx)));
  const real longer = fma(uz, z + *dz, fma(uy, y + *dy, ux * (x + *dx))) + squares;
  const real both = length + l0, area = both * length;
  const real one_over = area > 0.0f ? 1.0f / area : none;  // one division for e and 1 / |d|; no force where two nodes are at one place
  const real e = (longer * length) * one_over, inverse = both * one_over;
  real force = law_force(e, first, second, spring_curve, segments);
#if VISCOUS
  const real rate = (fma(wz, *dz, fma(wy, *dy, wx * *dx)) * inverse) / dt;
  force = fma(damper, rate, force);
#endif
#if SLACK
  force = e > 0.0f && force > 0.0f ? force : none;
#endif
  return force * inverse;
}
