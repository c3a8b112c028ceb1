// Central differences as equation 14 of the Hybrid Deformation Model writes them: node_w holds u_(n-1).
//   u_(n+1) = b (R - F) / m + b g + (1 + a) u_n - a u_(n-1), a and b as in integrate_increment.cl
#define W_OF(now, next) (now)

static inline motion advance(quad u, quad w, drive d, __global const float* step_params) {
  const quad half_hh = (0.5f * step_params[0]) * step_params[0];
  const quad push = push_of(d, fma(half_hh, d.decay, half_hh));
  const motion m = {fma(-d.decay, w, fma(1.0f + d.decay, u, push)), u};
  return m;
}
