// At every search for pairs: positions of all contact points, and bounding boxes of tiles. touch_box: [tiles, then groups of tiles][19] lower and
// upper bounds of position (3) [m], increment (3) [m] and normal (3), then the largest spacing [m].
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_lanes.cl"
#include "touch_frame.cl"

INLINE void place_points(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                         __global const int* contact_node, __global const float* contact_weight, __global const float* touch_surface,
                         __global float* touch_place, int first) {
  __global const int* node = contact_node + POINT_BASE(first, 8);
  __global const float* surface = touch_surface + POINT_BASE(first, PLIANT_TOUCH_SURFACE);
  touch_field f = no_field();
  for (int a = 0; a < 8; ++a) {
    add_corner(&f, a, texels_gather(node_u, node + a * PLIANT_TILE), texels_gather(node_w, node + a * PLIANT_TILE),
               contact_weight + POINT_BASE(first, 8), surface);
  }
  const real none = 0.0f;
  touch_lanes place;
  place.x = place_of_lanes(contact_rest, first, f);
  place.moved = f.w;
  place.yielding = none;
  set_frames(surface, f, &place);
  place.tilt = tilt_of(f, place);
  store_places(touch_place, first, place);
}

__kernel void touch_box(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                        __global const int* contact_node, __global const float* contact_weight,
                        __global const float* touch_surface, __global float* touch_place, __global float* touch_box) {
  const int tile = (int)get_global_id(0), begin = tile * PLIANT_TILE, end = begin + PLIANT_TILE;
  __global float* box = touch_box + tile * PLIANT_TOUCH_BOX;
  float low[9], high[9], largest = 0.0f;
  for (int k = 0; k < 9; ++k) {
    low[k] = 1e30f;
    high[k] = -1e30f;
  }
  for (int i = begin; i < end; i += LANES) {
    place_points(node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, touch_place, i);
  }
  for (int i = begin; i < end; ++i) {
    const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
    if (!(spacing > 0.0f)) continue;
    largest = largest < spacing ? spacing : largest;
    for (int k = 0; k < 9; ++k) {
      const float v = touch_place[PLIANT_TOUCH_PLACE * i + k + k / 3];
      low[k] = v < low[k] ? v : low[k];
      high[k] = v > high[k] ? v : high[k];
    }
  }
  for (int k = 0; k < 9; ++k) {
    box[2 * k] = low[k];
    box[2 * k + 1] = high[k];
  }
  box[18] = largest;
}
