// Central differences in increment form (Miller et al. 2007; Hybrid Deformation Model, equation 14): node_w holds u_n - u_(n-1).
//   w <- a w + b (R - F) / m + b g,  u <- u + w,  a = (1 - k) / (1 + k),  b = h^2 / (1 + k) = h^2 (1 + a) / 2,  k = c h / 2
#define W_OF(now, next) ((next) - (now))

static inline motion advance(quad u, quad w, drive d, __global const float* step_params) {
  const quad half_hh = (0.5f * step_params[0]) * step_params[0];
  const quad full = fma(d.decay, w, push_of(d, fma(half_hh, d.decay, half_hh)));
  const quad next = increment_of(full, step_params);
  const motion m = {displacement_of(u + next, step_params), next};
  return m;
}
