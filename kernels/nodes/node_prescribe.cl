// Prescribed components of displacement: u = target * curve(t + h), and node_w as the integrator defines it for the motion from target * curve(t).
// prescribed_node: [n]; prescribed_axes: [n] bit mask of x, y, z; prescribed_curve: [n][3] curve of each component;
// prescribed_target: [n] texels [m]; curve_value: [steps of the batch + 1][curves] factors.
#include "arith.cl"
#include "integrator.cl"

__kernel void node_prescribe(__global float* node_u, __global float* node_w, __global const int* prescribed_node,
                             __global const int* prescribed_axes, __global const int* prescribed_curve,
                             __global const float* prescribed_target, __global const float* curve_value, int curves, int step) {
  const int i = (int)get_global_id(0);
  const int node = 4 * prescribed_node[i], axes = prescribed_axes[i];
  for (int c = 0; c < 3; ++c) {
    if (axes & (1 << c)) {
      const float target = prescribed_target[4 * i + c];
      const int curve = prescribed_curve[3 * i + c];
      const float now = curve_value[step * curves + curve], next = curve_value[(step + 1) * curves + curve];
      node_u[node + c] = target * next;
      node_w[node + c] = target * W_OF(now, next);
    }
  }
}
