// Every few steps: the partners of each contact point until the next look. A pair of points pushes when
//   - their normals face each other within 60 degrees, and their tangential distance s is less than r = 1.2 spacings,
//   - their gap is less than the margin and twice what it loses at its present speed, and they are not deeper than one spacing (two,
//     when they were partners before): deeper is the other side of the part,
//   - in one body: they hang on different nodes, and at rest they were far from each other, or face to face; not two places beside each
//     other, and not the two sides of a thin part. What lay on each other at rest, like the faces of a cut, starts there.
// Its weight is (1 - s^2 / r^2)^2 times 2 cos - 1 of the angle between the normal and the other one turned round; touch_weight: [tiles][17][16] weights, then the sum of weights times areas of
// the partners [m^2]. The tree of boxes (touch_tree) is the same for all looks, so that the order of partners is. Of more
// partners than there is room for the weakest give way. contact_params: margin [m] and steps between two looks at 5 and 6.
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"

#define FOUND 64

// Whether points of two boxes can be partners before the next look.
static inline int may_meet(const float* a, __global const float* b, float margin, float ahead) {
  const float spacing = a[18] > b[18] ? a[18] : b[18], reach = fma(TOUCH_RADIUS, spacing, margin);
  float facing = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const float above = b[2 * c] - a[2 * c + 1], rising = a[2 * c + 7] - b[2 * c + 6];
    const float below = a[2 * c] - b[2 * c + 1], falling = b[2 * c + 7] - a[2 * c + 6];
    if (above - ahead * (rising > 0.0f ? rising : 0.0f) > reach) return 0;
    if (below - ahead * (falling > 0.0f ? falling : 0.0f) > reach) return 0;
    const float ll = a[2 * c + 12] * b[2 * c + 12], lh = a[2 * c + 12] * b[2 * c + 13];
    const float hl = a[2 * c + 13] * b[2 * c + 12], hh = a[2 * c + 13] * b[2 * c + 13];
    const float l = ll < lh ? ll : lh, m = hl < hh ? hl : hh;
    facing = facing + (l < m ? l : m);
  }
  return facing < -0.5f;
}

// 1: two points of one part that never touch; 0: they may, offset: their depth at rest [m].
static inline int one_part(__global const float* touch_surface, __global const float* touch_rest, __global const int* contact_node, int lower,
                           int upper, float large, float* offset) {
  *offset = 0.0f;
  if ((int)touch_rest[POINT_BASE(lower, 4) + 3 * PLIANT_TILE] != (int)touch_rest[POINT_BASE(upper, 4) + 3 * PLIANT_TILE]) return 0;
  int other = 0;
  for (int a = 0; a < 8; ++a)
    other |= contact_node[POINT_BASE(lower, 8) + a * PLIANT_TILE] ^ contact_node[POINT_BASE(upper, 8) + a * PLIANT_TILE];
  if (other == 0) return 1;
  const float4 away = three(touch_rest + POINT_BASE(lower, 4)) - three(touch_rest + POINT_BASE(upper, 4));
  __global const float* one = touch_surface + POINT_BASE(lower, PLIANT_TOUCH_SURFACE);
  __global const float* two = touch_surface + POINT_BASE(upper, PLIANT_TOUCH_SURFACE);
  const float4 na = cross3(three(one + 16 * PLIANT_TILE), three(one + 19 * PLIANT_TILE));
  const float4 nb = cross3(three(two + 16 * PLIANT_TILE), three(two + 19 * PLIANT_TILE));
  if (!(dot_xyz(away, away) < (16.0f * large) * large)) return 0;
  if (!(dot_xyz(na, nb) < -0.5f)) return 1;
  const float gap = dot_xyz(away, unit(nb - na));
  if (gap < -0.2f * large) return 1;
  *offset = gap < 0.0f ? gap : 0.0f;
  return 0;
}

// No point of box b is a partner of the point of box a that is farther from it than this.
static inline float farthest(const float* a, __global const float* b, float margin, float ahead) {
  const float spacing = a[18] > b[18] ? a[18] : b[18];
  float way = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const float rising = a[2 * c + 7] - b[2 * c + 6], falling = b[2 * c + 7] - a[2 * c + 6];
    way = way + (rising > falling ? rising : falling);
  }
  return fma(TOUCH_RADIUS + 2.0f, spacing, fma(ahead, way, margin));
}

static inline float weight_of(__global const float* touch_place, __global const float* touch_surface, __global const float* touch_rest,
                              __global const int* contact_node, int lower, int upper, int known, float margin, float ahead,
                              float* offset) {
  const touch_state a = state_of(touch_place, lower), b = state_of(touch_place, upper);
  const float facing = fma(-2.0f, dot_xyz(a.normal, b.normal), -1.0f);
  if (!(facing > 0.0f)) return 0.0f;
  const float one = touch_surface[POINT_BASE(lower, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  const float two = touch_surface[POINT_BASE(upper, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  const float large = one > two ? one : two;
  const touch_meeting m = meeting_of(a, b);
  const float4 side = fma((float4)(-m.gap), m.normal, m.apart);
  const float radius = TOUCH_RADIUS * large, part = dot_xyz(side, side) / (radius * radius);
  if (!(part < 1.0f)) return 0.0f;
  const float closing = -dot_xyz(a.moved - b.moved, m.normal);
  if (!(m.gap < fma(ahead, closing > 0.0f ? closing : 0.0f, margin))) return 0.0f;
  if (!(m.gap > (known ? -2.0f * large : -large))) return 0.0f;
  if (one_part(touch_surface, touch_rest, contact_node, lower, upper, large, offset)) return 0.0f;
  const float rest = 1.0f - part;
  return (rest * rest) * facing;
}

__kernel void touch_pair(__global const float* touch_place, __global const float* touch_box, __global const int* touch_node,
                         __global const float* touch_surface, __global const float* touch_rest, __global const float* contact_rest,
                         __global const int* contact_node, __global int* touch_partner, __global float* touch_pair,
                         __global float* touch_weight, __global int* contact_near, __global const float* contact_params,
                         int node_count) {
  const int tile = (int)get_global_id(0);
  const float margin = contact_params[5], ahead = 2.0f * contact_params[6];
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
    float kept[TOUCH_SLOTS][4];
    __global int* partner = touch_partner + POINT_BASE(i, TOUCH_SLOTS);
    __global float* weight = touch_weight + POINT_BASE(i, TOUCH_SLOTS + 1);
    for (int s = 0; s < TOUCH_SLOTS; ++s) {
      old[s] = partner[s * PLIANT_TILE];
      for (int c = 0; c < 4; ++c) kept[s][c] = touch_pair[pair_base(i, s) + (2 + c) * PLIANT_TILE];
      partner[s * PLIANT_TILE] = 0;
      weight[s * PLIANT_TILE] = 0.0f;
    }
    weight[TOUCH_SLOTS * PLIANT_TILE] = 0.0f;
    const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
    if (!(spacing > 0.0f)) continue;
    for (int k = 0; k < 9; ++k) box[2 * k] = box[2 * k + 1] = touch_place[POINT_BASE(i, PLIANT_TOUCH_PLACE) + k * PLIANT_TILE];
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
        __global const float* x = touch_place + POINT_BASE(j, PLIANT_TOUCH_PLACE);
        const float dx = x[0] - box[0], dy = x[PLIANT_TILE] - box[2], dz = x[2 * PLIANT_TILE] - box[4];
        if (!(dot3(dx, dx, dy, dy, dz, dz) < far * far)) continue;
        if (j == i || !(touch_surface[POINT_BASE(j, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE] > 0.0f)) continue;
        int before = 0;
        while (before < TOUCH_SLOTS && old[before] != j + 1) ++before;
        float offset;
        const float w = weight_of(touch_place, touch_surface, touch_rest, contact_node, i < j ? i : j, i < j ? j : i,
                                  before < TOUCH_SLOTS, margin, ahead, &offset);
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
        for (int c = 0; c < 4; ++c) numbers[(2 + c) * PLIANT_TILE] = before < TOUCH_SLOTS ? kept[before][c] : 0.0f;
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
  contact_near[tile] = (contact_near[tile] & ~PLIANT_TOUCH_BIT) | any;
}
