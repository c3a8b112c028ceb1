// External load R of the loaded nodes: forces times their curves, then pressure of the surface triangles, then forces of elements outside the bricks
// on brick nodes. All are summed in ascending order.
// load_node: [n]; load_offset: [n + 1][3] first force, triangle and corner of each node; load_force: texels [N]; load_curve;
// load_triangle, load_weight [1]; load_corner: positions in corner_force; pressure_force: [triangles] texels [N].
// curve_value: [steps + 1][curves], row `step` is the current time.
#include "arith.cl"

__kernel void node_load(__global float* node_load, __global const int* load_node, __global const int* load_offset,
                        __global const float* load_force, __global const int* load_curve, __global const int* load_triangle,
                        __global const float* load_weight, __global const int* load_corner, __global const float* pressure_force,
                        __global const float* corner_force, __global const float* curve_value, int curves, int step) {
  const int i = (int)get_global_id(0);
  __global const int* range = load_offset + 3 * i;
  float fx = 0.0f, fy = 0.0f, fz = 0.0f;
  for (int k = range[0]; k < range[3]; ++k) {
    const float factor = curve_value[step * curves + load_curve[k]];
    fx = fma(factor, load_force[4 * k], fx);
    fy = fma(factor, load_force[4 * k + 1], fy);
    fz = fma(factor, load_force[4 * k + 2], fz);
  }
  for (int k = range[1]; k < range[4]; ++k) {
    const float weight = load_weight[k];
    __global const float* f = pressure_force + 4 * load_triangle[k];
    fx = fma(weight, f[0], fx);
    fy = fma(weight, f[1], fy);
    fz = fma(weight, f[2], fz);
  }
  for (int k = range[2]; k < range[5]; ++k) {
    __global const float* f = corner_force + load_corner[k];
    fx -= f[0];
    fy -= f[PLIANT_TILE];
    fz -= f[2 * PLIANT_TILE];
  }
  __global float* out = node_load + 4 * load_node[i];
  out[0] = fx;
  out[1] = fy;
  out[2] = fz;
}
