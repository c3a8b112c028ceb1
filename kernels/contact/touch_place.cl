// Positions of contact points with partners after the trial step, and their compliance W if all points around push equally (contact_press). `again`:
// after the first part of the forces; frames are kept, and W is that of the touching points (contact_settle).
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_frame.cl"

__kernel void touch_place(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                          __global const int* contact_node, __global const float* contact_weight,
                          __global const float* contact_share, __global const int* contact_list, __global const int* contact_near,
                          __global float* contact_yield, __global const int* contact_change,
                          __global const float* contact_node_sum, __global const float* touch_surface, __global float* touch_place,
                          __global const float* step_params, int again) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  if ((contact_near[first / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) return;
  const float h = step_params[0], half_hh = (0.5f * h) * h;
  for (int i = first; i < first + LANES; ++i) {
    const contact_place p = place_of_point(node_u, node_w, contact_rest, contact_node, contact_weight, i);
    touch_state place = state_of(touch_place, i);
    place.x = p.now;
    place.moved = (float4)(p.moved.xyz, 0.0f);
    if (again == 0) set_frame(node_u, node_w, contact_node, touch_surface, i, &place);
    place.tilt = tilt_of(node_w, contact_node, touch_surface, i, place);
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
    if (again != 0) {
      const int counted = contact_change[POINT_BASE(i, 4) + 3 * PLIANT_TILE] != 0;
      contact_yield[i] = counted && moving > 0.0f ? w * (whole / moving) : 0.0f;
    } else {
      place.yielding = contact_yield[i] > 0.0f ? contact_yield[i] : w;
    }
    write_state(touch_place, i, place);
  }
}
