// Common end of every update kernel: external loads and a step of the integrator, see node_update.cl.
#include "integrator.cl"
#if LANES == 16
#define LOAD_QUAD(p) vload16(0, (p) + 4 * i)
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

static inline void integrate(real fx, real fy, real fz, __global float* node_u, __global float* node_w, __global const float* node_load,
                      __global float* node_force, __global const float* step_params, int i) {
#if LANES == 16
#define FORCE_TEXEL(n) fx.s##n, fy.s##n, fz.s##n, 0.0f
#define FORCE_QUAD(n0, n1, n2, n3) (quad)(FORCE_TEXEL(n0), FORCE_TEXEL(n1), FORCE_TEXEL(n2), FORCE_TEXEL(n3))
  integrate_quad(FORCE_QUAD(0, 1, 2, 3), node_u, node_w, node_load, node_force, step_params, i);
  integrate_quad(FORCE_QUAD(4, 5, 6, 7), node_u, node_w, node_load, node_force, step_params, i + 4);
  integrate_quad(FORCE_QUAD(8, 9, a, b), node_u, node_w, node_load, node_force, step_params, i + 8);
  integrate_quad(FORCE_QUAD(c, d, e, f), node_u, node_w, node_load, node_force, step_params, i + 12);
#else
  integrate_quad((quad)(fx, fy, fz, 0.0f), node_u, node_w, node_load, node_force, step_params, i);
#endif
}
