// Edges of blades that cut by force, after the trial step. A sample of the edge that has met material has a front point x_f, which some nodes carry,
// and a direction n in which it presses; it has gone `front` through the material since the front point was placed. What it is beyond that,
//   g = (x_edge - x_f) . n - front,
// is taken back by a force f = g / W along n, but by no more than the limit F* at which tissue gives way; then f = F* and the front advances by
// g - F* W, as in the return mapping of plasticity (Simo and Hughes 1998). W = b sum_j w_j s_j / m_j, with the sum s_j of the weights of all samples at
// node j, bounds a row sum of the compliance (Gershgorin), so that samples with common nodes never overshoot together. Friction opposes the slip of the
// step: min(mu f, slip / W).
// blade_node: [samples][8] slots; blade_weight: [samples][8]; blade_share: [samples][8] w_j s_j, 0 at held nodes; blade_data: [samples][12] undeformed x_f
// (3) [m], n (3), F* [N] (negative: no front point), mu, place along the edge in [0, 1], blade (3 unused); blade_pose: [steps + 1][blades][6] first end,
// vector to the other end [m]; blade_front: [samples][2] front [m], steps in which it pressed; blade_force: [steps][samples][4] force on tissue (3), f [N].
#include "arith.cl"

#define BLADE_DATA 12
#define BLADE_POSE 6

static inline float dot_of(float4 a, float4 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

static inline float4 edge_at(__global const float* pose, float place) {
  const float4 from = (float4)(pose[0], pose[1], pose[2], 0.0f), along = (float4)(pose[3], pose[4], pose[5], 0.0f);
  return fma((float4)(place), along, from);
}

__kernel void blade_press(__global const float* node_u, __global const float* node_w, __global const int* blade_node, __global const float* blade_weight,
                          __global const float* blade_share, __global const float* blade_data, __global const float* blade_pose,
                          __global float* blade_front, __global float* blade_force, __global const float* step_params, int samples, int blades,
                          int step) {
  const int i = (int)get_global_id(0);
  __global const float* data = blade_data + BLADE_DATA * i;
  __global float* out = blade_force + 4 * (step * samples + i);
  const float most = data[6], h = step_params[0], half_hh = (0.5f * h) * h;
  float4 f = (float4)(0.0f);
  if (most >= 0.0f) {
    float4 x = (float4)(data[0], data[1], data[2], 0.0f), moved = (float4)(0.0f);
    float w = 0.0f;
    for (int a = 0; a < 8; ++a) {
      const int at = 8 * i + a, slot = 4 * blade_node[at];
      const float4 part = (float4)(blade_weight[at]);
      x = fma(part, (float4)(node_u[slot], node_u[slot + 1], node_u[slot + 2], 0.0f), x);
      moved = fma(part, (float4)(node_w[slot], node_w[slot + 1], node_w[slot + 2], 0.0f), moved);
      w = fma(blade_share[at], fma(half_hh, node_w[slot + 3], half_hh) * node_u[slot + 3], w);
    }
    __global const float* pose = blade_pose + BLADE_POSE * (step * blades + (int)data[9]);
    const float4 before = edge_at(pose, data[8]), now = edge_at(pose + BLADE_POSE * blades, data[8]);
    const float4 n = (float4)(data[3], data[4], data[5], 0.0f);
    const float gap = dot_of(now - x, n) - blade_front[2 * i];
    if (gap > 0.0f && w > 0.0f) {
      float push = gap / w;
      if (push > most) {
        push = most;
        blade_front[2 * i] += gap - most * w;
      }
      blade_front[2 * i + 1] += 1.0f;
      f = n * push;
      const float4 slip = moved - (now - before);
      const float4 side = fma((float4)(-dot_of(slip, n)), n, slip);
      const float length = sqrt(dot_of(side, side)), hold = data[7] * push;
      if (hold > 0.0f && length > 0.0f) {
        const float pull = length / w, factor = (pull < hold ? pull : hold) / length;
        f = fma((float4)(-factor), side, f);
      }
      f.w = push;
    }
  }
  out[0] = f.x;
  out[1] = f.y;
  out[2] = f.z;
  out[3] = f.w;
}
