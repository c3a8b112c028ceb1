// Prescribed rotation about an axis: u = p (cos(angle) - 1) + q sin(angle) at t + h, and node_w as the integrator defines it for this motion. The
// host provides cos - 1 and, as the next curve, the sine, since kernels may not use trigonometric functions. rotated_node: [n]; rotated_axes: [n] bit
// mask of x, y, z; rotated_curve: [n][3] curve of each component; rotated_cosine, rotated_sine: [n] texels p, q [m]; curve_value: [steps of the batch
// + 1][curves].
#include "arith.cl"
#include "integrator.cl"

__kernel void node_rotate(__global float* node_u, __global float* node_w, __global const int* rotated_node,
                          __global const int* rotated_axes, __global const int* rotated_curve,
                          __global const float* rotated_cosine, __global const float* rotated_sine,
                          __global const float* curve_value, int curves, int step) {
  const int i = (int)get_global_id(0);
  const int node = 4 * rotated_node[i], axes = rotated_axes[i];
  for (int c = 0; c < 3; ++c) {
    if (axes & (1 << c)) {
      const float p = rotated_cosine[4 * i + c], q = rotated_sine[4 * i + c];
      __global const float* now = curve_value + step * curves + rotated_curve[3 * i + c];
      __global const float* next = now + curves;
      const float swing = q * next[1];
      node_u[node + c] = fma(p, next[0], swing);
      const float turned = q * W_OF(now[1], next[1]);
      node_w[node + c] = fma(p, W_OF(now[0], next[0]), turned);
    }
  }
}
