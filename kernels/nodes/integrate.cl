// Common end of every update kernel: external loads and a step of the integrator, see node_update.cl.
#include "integrator.cl"
#if LANES == 16
#define LOAD_QUAD(p) BLOCK16((p) + 4 * i, 0)
#define STORE_QUAD(q, p) vstore16(q, 0, (p) + 4 * i)
#define GRAVITY (float4)(step_params[1], step_params[2], step_params[3], 0.0f)
#define GRAVITY_QUAD (quad)(GRAVITY, GRAVITY, GRAVITY, GRAVITY)
#else
#define LOAD_QUAD(p) vload4(i, p)
#define STORE_QUAD(q, p) vstore4(q, i, p)
#define GRAVITY_QUAD (quad)(step_params[1], step_params[2], step_params[3], 0.0f)
#endif

// f: summed element forces (w is unused); i: first texel of the quad.
INLINE void integrate_quad(quad f, __global float* node_u, __global float* node_w, __global const float* node_load,
                   __global float* node_force, __global const float* step_params, int i) {
#if HAS_LOAD
  const quad r = LOAD_QUAD(node_load) - f;
#else
  const quad r = -f;
#endif
#if FORCE_ONLY
  const quad zero = 0.0f;
  STORE_QUAD(QUAD_XYZW(r, zero), node_force);
#else
  const quad u = LOAD_QUAD(node_u), w = LOAD_QUAD(node_w);
  const drive d = {r, QUAD_W(u), GRAVITY_QUAD, QUAD_W(w)};
  const motion next = advance(u, w, d, step_params);
  STORE_QUAD(QUAD_XYZW(next.w, w), node_w);
  STORE_QUAD(QUAD_XYZW(next.u, u), node_u);
#endif
}

#if LANES == 16
// Eight nodes, unpacked within 128-bit lanes, for which PoCL needs fewer instructions than for wider shuffles.
INLINE void integrate_half(float8 x, float8 y, float8 z, __global float* node_u, __global float* node_w, __global const float* node_load,
                   __global float* node_force, __global const float* step_params, int i) {
  const float8 none = 0.0f, xy0 = UNPACK_LO(x, y), xy1 = UNPACK_HI(x, y), z0 = UNPACK_LO(z, none), z1 = UNPACK_HI(z, none);
  const float8 a = PAIRS_LO(xy0, z0), b = PAIRS_HI(xy0, z0), c = PAIRS_LO(xy1, z1), d = PAIRS_HI(xy1, z1);
  integrate_quad((quad)(a.lo, b.lo, c.lo, d.lo), node_u, node_w, node_load, node_force, step_params, i);
  integrate_quad((quad)(a.hi, b.hi, c.hi, d.hi), node_u, node_w, node_load, node_force, step_params, i + 4);
}
#endif

static inline void integrate(real fx, real fy, real fz, __global float* node_u, __global float* node_w, __global const float* node_load,
                      __global float* node_force, __global const float* step_params, int i) {
#if LANES == 16
  integrate_half(fx.lo, fy.lo, fz.lo, node_u, node_w, node_load, node_force, step_params, i);
  integrate_half(fx.hi, fy.hi, fz.hi, node_u, node_w, node_load, node_force, step_params, i + 8);
#else
  integrate_quad((quad)(fx, fy, fz, 0.0f), node_u, node_w, node_load, node_force, step_params, i);
#endif
}
