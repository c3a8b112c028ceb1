// Every few steps: finds the partners of each contact point until the next search. A pair of points pushes if
//   - their normals face each other within 60 degrees, and their tangential distance s is less than r = 1.2 spacings,
//   - their gap is less than the margin plus twice its decrease until the next search at the present speed, and they are at most one spacing deep (two
//     if they were partners before), since deeper points belong to the other side of the part,
//   - in the same body: they have different nodes, and undeformed they were far apart or face to face; neighbours and the two sides of a thin part
//     are excluded.
// Points that coincide undeformed, such as the faces of a cut, start at zero depth. The weight is (1 - s^2 / r^2)^2 times 2 cos - 1 of the angle
// between the normal and the reversed other normal. touch_weight: [tiles][17][16] weights, then the sum of weights times areas of the partners [m^2].
// The tree of boxes (touch_tree) is the same for all searches, and so is the order of partners. If there are more partners than slots, those with the
// least weight are dropped. contact_params: margin [m] at 5, steps between two searches at 6, ease of an offset at 8.
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_lanes.cl"
#include "touch_meeting.cl"
#include "touch_meet.cl"
#include "touch_partners.cl"

#define FOUND 64

__kernel void touch_pair(__global const float* touch_place, __global const float* touch_box, __global const int* touch_node,
                         __global const float* touch_surface, __global const float* touch_rest, __global const float* contact_rest,
                         __global const int* contact_node, __global int* touch_partner, __global float* touch_pair,
                         __global float* touch_weight, __global int* contact_near, __global float* contact_yield, __global const float* contact_params,
                         int node_count) {
  const int tile = (int)get_global_id(0);
  const float margin = contact_params[5], ahead = 2.0f * contact_params[6], ease = contact_params[8];
  float box[PLIANT_TOUCH_BOX];
  for (int b = 0; b < PLIANT_TOUCH_BOX; ++b) box[b] = touch_box[tile * PLIANT_TOUCH_BOX + b];
  int found[FOUND];
  int count = 0;
  for (int k = 0; k < node_count;) {
    __global const int* node = touch_node + PLIANT_TOUCH_TREE * k;
    if (!may_meet(box, touch_box + PLIANT_TOUCH_BOX * node[0], margin, ahead)) {
      k = node[1];
      continue;
    }
    if (node[3] - node[2] == 1) {
      if (count < FOUND) found[count] = k;
      ++count;
    }
    ++k;
  }
  const int listed = count <= FOUND;
#if LANES == 16
  int meeting[FOUND];  // the points of this tile that may meet those of each listed one
  const vec3 x = xyz(own_texels(touch_place, tile * PLIANT_TILE, 0)), moved = xyz(own_texels(touch_place, tile * PLIANT_TILE, 1));
  const vec3 normal = xyz(own_texels(touch_place, tile * PLIANT_TILE, 2));
  const real spacings = LOAD(touch_surface, POINT_BASE(tile * PLIANT_TILE, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE);
  for (int k = 0; k < count && listed; ++k) {
    const int other = touch_node[PLIANT_TOUCH_TREE * found[k]];
    meeting[k] = meeting_points(x, moved, normal, spacings, touch_box + PLIANT_TOUCH_BOX * other, margin, ahead);
  }
#define MAY_MEET(k, node) (listed ? meeting[k] >> (i % PLIANT_TILE) & 1 : may_meet(box, touch_box + PLIANT_TOUCH_BOX * (node)[0], margin, ahead))
#else
#define MAY_MEET(k, node) may_meet(box, touch_box + PLIANT_TOUCH_BOX * (node)[0], margin, ahead)
#endif
  int any = 0;
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
    touch_partners partners;
    begin_partners(&partners, i, touch_partner, touch_pair, touch_weight);
    const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
    if (!(spacing > 0.0f)) continue;
    for (int k = 0; k < 9; ++k) box[2 * k] = box[2 * k + 1] = touch_place[PLIANT_TOUCH_PLACE * i + k + k / 3];
    box[18] = spacing;
    for (int k = 0; k < (listed ? count : node_count);) {
      __global const int* node = touch_node + PLIANT_TOUCH_TREE * (listed ? found[k] : k);
      if (!MAY_MEET(k, node)) {
        k = listed ? k + 1 : node[1];
        continue;
      }
      ++k;
      if (node[3] - node[2] != 1) continue;
      const float far = farthest(box, touch_box + PLIANT_TOUCH_BOX * node[0], margin, ahead);
      try_tile(&partners, i, node[2], far, spacing, margin, ahead, ease, touch_place, touch_surface, touch_rest, contact_node, touch_partner, touch_pair,
               touch_weight);
    }
    float sum = 0.0f;
    for (int s = 0; s < partners.filled; ++s) {
      const int j = touch_partner[POINT_BASE(i, TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      sum = fma(contact_rest[POINT_BASE(j, 4) + 3 * PLIANT_TILE], touch_weight[POINT_BASE(i, TOUCH_SLOTS + 1) + s * PLIANT_TILE], sum);
    }
    touch_weight[POINT_BASE(i, TOUCH_SLOTS + 1) + TOUCH_SLOTS * PLIANT_TILE] = sum;
    if (partners.filled > 0) any = PLIANT_TOUCH_BIT;
  }
  const int before = contact_near[tile], near = (before & ~PLIANT_TOUCH_BIT) | any;
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE && near == 0 && before != 0; ++i) contact_yield[i] = 0.0f;
  contact_near[tile] = near;
}
