// The last lines of every update kernel: external loads and central differences, see node_update.cl.
inline void integrate(real fx, real fy, real fz, __global float* node_u, __global float* node_w, __global const float* node_load,
                      __global float* node_force, __global const float* step_params, int i) {
#if HAS_LOAD
  const texels load = texels_load(node_load, i);
  const real rx = texels_x(load) - fx, ry = texels_y(load) - fy, rz = texels_z(load) - fz;
#else
  const real rx = -fx, ry = -fy, rz = -fz;
#endif
#if FORCE_ONLY
  const real none = 0.0f;
  texels_store(rx, ry, rz, none, node_force, i);
#else
  const float h = step_params[0];
  const texels u = texels_load(node_u, i), w = texels_load(node_w, i);
  const real inverse_mass = texels_w(u), damping = texels_w(w);
  const float half_h = 0.5f * h;
  const real rate = damping + step_params[4];
  const real inverse = 1.0f / fma(half_h, rate, 1.0f);
  const real a = fma(-half_h, rate, 1.0f) * inverse, b = (h * h) * inverse;
  const real bm = b * inverse_mass;
  const real free = inverse_mass > 0.0f ? b : (real)(0.0f);  // slots without a node stay where they are
  const real gx = fma(bm, rx, free * step_params[1]), gy = fma(bm, ry, free * step_params[2]), gz = fma(bm, rz, free * step_params[3]);
#if TEXTBOOK
  const real two = 2.0f * inverse;
  const real ux = fma(-a, texels_x(w), fma(two, texels_x(u), gx));
  const real uy = fma(-a, texels_y(w), fma(two, texels_y(u), gy));
  const real uz = fma(-a, texels_z(w), fma(two, texels_z(u), gz));
  texels_store(texels_x(u), texels_y(u), texels_z(u), damping, node_w, i);
  texels_store(ux, uy, uz, inverse_mass, node_u, i);
#else
  const real wx = fma(a, texels_x(w), gx), wy = fma(a, texels_y(w), gy), wz = fma(a, texels_z(w), gz);
  texels_store(texels_x(u) + wx, texels_y(u) + wy, texels_z(u) + wz, inverse_mass, node_u, i);
  texels_store(wx, wy, wz, damping, node_w, i);
#endif
#endif
}
