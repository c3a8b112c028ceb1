// The integrator, selected by the define INTEGRATOR (integrators.h). Its fragment integrate_STEM.cl defines
//   W_OF(now, next)                               node_w of a component that is moved from `now` to `next`; linear in both
//   motion advance(quad u, quad w, drive d, ...)  a step of four nodes from their node_u and node_w
// It operates on texels in memory order, four at a time (a quad), so that only the forces need unpacking.
#if LANES == 16
typedef float16 quad;
#define QUAD_W(q) (float16)((q).s3333, (q).s7777, (q).sbbbb, (q).sffff)
// xyz of the first argument, w of the second.
#define QUAD_XYZW(q, r) (float16)((q).s012, (r).s3, (q).s456, (r).s7, (q).s89a, (r).sb, (q).scde, (r).sf)
#else
typedef float4 quad;
#define QUAD_W(q) (q).wwww
#define QUAD_XYZW(q, r) (float4)((q).xyz, (r).w)
#endif

// Input of a step of four nodes: R - F [N], 1/m [1/kg], gravity [m/s^2] and each node's decay from the host (host/integrators).
typedef struct {
  quad force, inverse_mass, gravity, decay;
} drive;

// node_u and node_w after the step.
typedef struct {
  quad u, w;
} motion;

// `share` h^2 (R - F) / m and the same for gravity [m]. Slots without a node do not move.
static inline quad push_of(drive d, quad share) {
  const quad zero = 0.0f;
  const quad free = d.inverse_mass > 0.0f ? share : zero;
  return fma(share * d.inverse_mass, d.force, free * d.gravity);
}

// Increments below `still` become 0, and displacements below `fine` are rounded to the grid (node_update.cl).
static inline quad increment_of(quad w, __global const float* step_params) {
  const quad zero = 0.0f;
  return fabs(w) < step_params[4] ? zero : w;
}
static inline quad displacement_of(quad u, __global const float* step_params) {
  const quad anchor = 3.0f * step_params[5];
  return fabs(u) < step_params[5] ? (u + anchor) - anchor : u;
}

#include "integrators.cl"
