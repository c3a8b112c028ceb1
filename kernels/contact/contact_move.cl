// Moves a node by a force of contact, after the trial step: u and w of its free components change by b f / m. free: bit mask; half_hh: h^2 / 2 [s^2].
INLINE void contact_move(__global float* u, __global float* w, int free, float half_hh, float fx, float fy, float fz) {
  if (free == 0) return;
  const float bm = fma(half_hh, w[3], half_hh) * u[3];
  if (free & 1) {
    u[0] = fma(bm, fx, u[0]);
    w[0] = fma(bm, fx, w[0]);
  }
  if (free & 2) {
    u[1] = fma(bm, fy, u[1]);
    w[1] = fma(bm, fy, w[1]);
  }
  if (free & 4) {
    u[2] = fma(bm, fz, u[2]);
    w[2] = fma(bm, fz, w[2]);
  }
}
