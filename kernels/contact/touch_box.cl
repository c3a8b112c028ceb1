// At every search for pairs: positions of all contact points, and bounding boxes of tiles. touch_box: [tiles, then groups of tiles][19] lower and
// upper bounds of position (3) [m], increment (3) [m] and normal (3), then the largest spacing [m].
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_frame.cl"

__kernel void touch_box(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                        __global const int* contact_node, __global const float* contact_weight,
                        __global const float* touch_surface, __global float* touch_place, __global float* touch_box) {
  const int tile = (int)get_global_id(0);
  __global float* box = touch_box + tile * PLIANT_TOUCH_BOX;
  float low[9], high[9], largest = 0.0f;
  for (int k = 0; k < 9; ++k) {
    low[k] = 1e30f;
    high[k] = -1e30f;
  }
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
    const contact_place p = place_of_point(node_u, node_w, contact_rest, contact_node, contact_weight, i);
    touch_state place;
    place.x = p.now;
    place.moved = (float4)(p.moved.xyz, 0.0f);
    place.yielding = 0.0f;
    set_frame(node_u, node_w, contact_node, touch_surface, i, &place);
    place.tilt = tilt_of(node_w, contact_node, touch_surface, i, place);
    write_state(touch_place, i, place);
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
