// Positions of contact points with partners after the trial step, and their compliance W if all points around push equally (contact_press). `again`:
// after the first part of the forces; frames are kept, and W is that of the touching points (contact_settle).
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_lanes.cl"
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
  const float h = step_params[0];
  const real half_hh = (0.5f * h) * h, none = 0.0f;
  __global const int* node = contact_node + POINT_BASE(first, 8);
  __global const float* weight = contact_weight + POINT_BASE(first, 8);
  __global const float* shares = contact_share + POINT_BASE(first, 8);
  __global const float* surface = touch_surface + POINT_BASE(first, PLIANT_TOUCH_SURFACE);
  touch_field f = no_field();
  real w = none, whole = none, moving = none;
  for (int a = 0; a < 8; ++a) {
    const texels at = texels_gather(node_u, node + a * PLIANT_TILE), moved = texels_gather(node_w, node + a * PLIANT_TILE);
    add_corner(&f, a, at, moved, weight, surface);
    const real b = fma(half_hh, texels_w(moved), half_hh), share = LOAD(shares, a * PLIANT_TILE), c = LOAD(weight, a * PLIANT_TILE);
    real own = share;
    if (again != 0) {
      const real sum = texels_w(texels_gather(contact_node_sum, node + a * PLIANT_TILE));
      own = c > 0.0f ? c * sum : none;
    }
    const real free = share > 0.0f ? own : none;
    w = fma(free, b * texels_w(at), w);
    whole = whole + own;
    moving = moving + free;
  }
  touch_lanes place = own_lanes(touch_place, first);
  place.x = place_of_lanes(contact_rest, first, f);
  place.moved = f.w;
  if (again == 0) set_frames(surface, f, &place);
  place.tilt = tilt_of(f, place);
  const real known = LOAD(contact_yield, first);
  if (again != 0) {
    const integer counted = LOAD(contact_change, POINT_BASE(first, 4) + 3 * PLIANT_TILE) != 0;
    const real yields = w * (whole / moving);
    STORE(counted && moving > 0.0f ? yields : none, contact_yield, first);
  } else {
    place.yielding = known > 0.0f ? known : w;
  }
  store_places(touch_place, first, place);
}
