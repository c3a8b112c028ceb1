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
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_meet.cl"

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
  int any = 0;
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
    int old[TOUCH_SLOTS];
    float kept[TOUCH_SLOTS][PLIANT_TOUCH_PAIR];
    __global int* partner = touch_partner + POINT_BASE(i, TOUCH_SLOTS);
    __global float* weight = touch_weight + POINT_BASE(i, TOUCH_SLOTS + 1);
    for (int s = 0; s < TOUCH_SLOTS; ++s) {
      old[s] = partner[s * PLIANT_TILE];
      for (int c = 0; c < PLIANT_TOUCH_PAIR; ++c) kept[s][c] = touch_pair[pair_base(i, s) + c * PLIANT_TILE];
      partner[s * PLIANT_TILE] = 0;
      weight[s * PLIANT_TILE] = 0.0f;
    }
    weight[TOUCH_SLOTS * PLIANT_TILE] = 0.0f;
    const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
    if (!(spacing > 0.0f)) continue;
    for (int k = 0; k < 9; ++k) box[2 * k] = box[2 * k + 1] = touch_place[PLIANT_TOUCH_PLACE * i + k + k / 3];
    box[18] = spacing;
    int filled = 0;
    for (int k = 0; k < (listed ? count : node_count);) {
      __global const int* node = touch_node + PLIANT_TOUCH_TREE * (listed ? found[k] : k);
      if (!may_meet(box, touch_box + PLIANT_TOUCH_BOX * node[0], margin, ahead)) {
        k = listed ? k + 1 : node[1];
        continue;
      }
      ++k;
      if (node[3] - node[2] != 1) continue;
      const float far = farthest(box, touch_box + PLIANT_TOUCH_BOX * node[0], margin, ahead);
      for (int j = node[2] * PLIANT_TILE; j < node[3] * PLIANT_TILE; ++j) {
        __global const float* x = touch_place + PLIANT_TOUCH_PLACE * j;
        const float dx = x[0] - box[0], dy = x[1] - box[2], dz = x[2] - box[4];
        if (!(dot3(dx, dx, dy, dy, dz, dz) < far * far)) continue;
        if (j == i || !(touch_surface[POINT_BASE(j, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE] > 0.0f)) continue;
        int before = 0;
        while (before < TOUCH_SLOTS && old[before] != j + 1) ++before;
        const int known = before < TOUCH_SLOTS && kept[before < TOUCH_SLOTS ? before : 0][0] > 0.0f;  // partners of each other before
        float offset;
        const float w = weight_of(touch_place, touch_surface, touch_rest, contact_node, i < j ? i : j, i < j ? j : i,
                                  known, known ? kept[before][1] : 0.0f, margin, ahead, ease, &offset);
        if (!(w > 0.0f)) continue;
        int slot = filled;
        if (filled == TOUCH_SLOTS) {
          slot = 0;
          for (int s = 1; s < TOUCH_SLOTS; ++s) slot = weight[s * PLIANT_TILE] < weight[slot * PLIANT_TILE] ? s : slot;
          if (!(w > weight[slot * PLIANT_TILE])) continue;
        } else {
          ++filled;
        }
        partner[slot * PLIANT_TILE] = j + 1;
        weight[slot * PLIANT_TILE] = w;
        __global float* numbers = touch_pair + pair_base(i, slot);
        numbers[PLIANT_TILE] = offset;
        for (int c = 2; c < PLIANT_TOUCH_PAIR; ++c) numbers[c * PLIANT_TILE] = known ? kept[before][c] : 0.0f;
      }
    }
    float sum = 0.0f;
    for (int s = 0; s < filled; ++s) {
      const int j = partner[s * PLIANT_TILE] - 1;
      sum = fma(contact_rest[POINT_BASE(j, 4) + 3 * PLIANT_TILE], weight[s * PLIANT_TILE], sum);
    }
    weight[TOUCH_SLOTS * PLIANT_TILE] = sum;
    if (filled > 0) any = PLIANT_TOUCH_BIT;
  }
  const int before = contact_near[tile], near = (before & ~PLIANT_TOUCH_BIT) | any;
  for (int i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE && near == 0 && before != 0; ++i) contact_yield[i] = 0.0f;
  contact_near[tile] = near;
}
