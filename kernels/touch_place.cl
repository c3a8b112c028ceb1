// Where contact points near others are after the trial step, and W, what their place yields when all points around push as hard
// (contact_press). `again`: after the first part of the forces; frames stay, W is that of the points that touch (contact_settle).
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"

__kernel void touch_place(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                          __global const int* contact_node, __global const float* contact_weight,
                          __global const float* contact_share, __global const int* contact_near,
                          __global const float* contact_node_sum, __global const float* touch_surface, __global float* touch_place,
                          __global const float* step_params, int again) {
  const int first = FIRST_INDEX;
  if ((contact_near[first / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h;
  for (int i = first; i < first + LANES; ++i) {
    write_place(node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, touch_place, i, again);
    __global const int* node = contact_node + POINT_BASE(i, 8);
    float w = 0.0f, whole = 0.0f, moving = 0.0f;
    for (int a = 0; a < 8; ++a) {
      const int n = node[a * PLIANT_TILE];
      const float b = fma(half_hh, node_w[4 * n + 3], half_hh), share = contact_share[POINT_BASE(i, 8) + a * PLIANT_TILE];
      const float c = contact_weight[POINT_BASE(i, 8) + a * PLIANT_TILE];
      const float own = again == 0 ? share : c > 0.0f ? c * contact_node_sum[4 * n + 3] : 0.0f;
      const float free = share > 0.0f ? own : 0.0f;
      w = fma(free, b * node_u[4 * n + 3], w);
      whole = whole + own;
      moving = moving + free;
    }
    if (again != 0) w = moving > 0.0f ? w * (whole / moving) : 0.0f;
    touch_place[PLIANT_TOUCH_PLACE * i + 3] = w;
  }
}
