// Follower pressure: the force on a deformed surface triangle, -p(t) (x1 - x0) x (x2 - x0) / 2 [N]; load_weight distributes it to its corners.
// pressure_triangle: [n][3] surface vertices; pressure_value: [n] p [Pa]; pressure_curve: [n]; pressure_force: [n] texels.
#include "arith.cl"

__kernel void pressure_force(__global const float* surface_x, __global const int* pressure_triangle,
                             __global const float* pressure_value, __global const int* pressure_curve, __global float* pressure_force,
                             __global const float* curve_value, int curves, int step) {
  const int i = (int)get_global_id(0);
  __global const float* a = surface_x + 4 * pressure_triangle[3 * i];
  __global const float* b = surface_x + 4 * pressure_triangle[3 * i + 1];
  __global const float* c = surface_x + 4 * pressure_triangle[3 * i + 2];
  const float ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
  const float gx = c[0] - a[0], gy = c[1] - a[1], gz = c[2] - a[2];
  const float s = -0.5f * (pressure_value[i] * curve_value[step * curves + pressure_curve[i]]);
  __global float* out = pressure_force + 4 * i;
  out[0] = s * fma(ey, gz, -(ez * gy));
  out[1] = s * fma(ez, gx, -(ex * gz));
  out[2] = s * fma(ex, gy, -(ey * gx));
  out[3] = 0.0f;
}
