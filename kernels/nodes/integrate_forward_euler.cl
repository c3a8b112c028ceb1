// Explicit Euler, Y <- Y + h f(Y) with Y = (u, v). node_w holds h v, the velocity of the next displacement update.
//   u <- u + w,  w <- a w + h^2 ((R - F) / m + g), all at the old u and w;  a = 1 - c h
#define W_OF(now, next) ((next) - (now))

static inline motion advance(quad u, quad w, drive d, __global const float* step_params) {
  const quad hh = step_params[0] * step_params[0];
  const quad next = fma(d.decay, w, push_of(d, hh));
  const motion m = {displacement_of(u + w, step_params), increment_of(next, step_params)};
  return m;
}
