// The last lines of every update kernel: external loads and central differences, see node_update.cl. They work on texels as they lie in
// memory, four at a time (a quad), so that nothing is unpacked but the forces.
#if LANES == 16
typedef float16 quad;
#define QUAD_W(q) (float16)((q).s3333, (q).s7777, (q).sbbbb, (q).sffff)
// xyz of the first, w of the second.
#define QUAD_XYZW(q, r) (float16)((q).s012, (r).s3, (q).s456, (r).s7, (q).s89a, (r).sb, (q).scde, (r).sf)
#else
typedef float4 quad;
#define QUAD_W(q) (q).wwww
#define QUAD_XYZW(q, r) (float4)((q).xyz, (r).w)
#endif

// f: summed element forces (w is not used); i: first texel of the quad.
static inline void integrate_quad(quad f, __global float* node_u, __global float* node_w, __global const float* node_load,
                           __global float* node_force, __global const float* step_params, int i) {
#if LANES == 16
#define LOAD_QUAD(p) vload16(0, (p) + 4 * i)
#define STORE_QUAD(q, p) vstore16(q, 0, (p) + 4 * i)
  const quad gravity = (quad)((float4)(step_params[1], step_params[2], step_params[3], 0.0f),
                              (float4)(step_params[1], step_params[2], step_params[3], 0.0f),
                              (float4)(step_params[1], step_params[2], step_params[3], 0.0f),
                              (float4)(step_params[1], step_params[2], step_params[3], 0.0f));
#else
#define LOAD_QUAD(p) vload4(i, p)
#define STORE_QUAD(q, p) vstore4(q, i, p)
  const quad gravity = (quad)(step_params[1], step_params[2], step_params[3], 0.0f);
#endif
  const quad zero = 0.0f;
#if HAS_LOAD
  const quad r = LOAD_QUAD(node_load) - f;
#else
  const quad r = -f;
#endif
#if FORCE_ONLY
  STORE_QUAD(QUAD_XYZW(r, zero), node_force);
#else
  const quad u = LOAD_QUAD(node_u), w = LOAD_QUAD(node_w);
  const quad inverse_mass = QUAD_W(u), a = QUAD_W(w);
  const quad half_hh = (0.5f * step_params[0]) * step_params[0];
  const quad b = fma(half_hh, a, half_hh);
  const quad free = inverse_mass > 0.0f ? b : zero;  // slots without a node stay where they are
  const quad push = fma(b * inverse_mass, r, free * gravity);
#if TEXTBOOK
  const quad next = fma(-a, w, fma(1.0f + a, u, push));
  STORE_QUAD(QUAD_XYZW(u, w), node_w);
  STORE_QUAD(QUAD_XYZW(next, u), node_u);
#else
  const quad full = fma(a, w, push);
  const quad next = fabs(full) < step_params[4] ? zero : full;
  STORE_QUAD(QUAD_XYZW(next, w), node_w);
  const quad sum = u + next, anchor = 3.0f * step_params[5];
  STORE_QUAD(QUAD_XYZW(fabs(sum) < step_params[5] ? (sum + anchor) - anchor : sum, u), node_u);
#endif
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
