// Search for pairs of contact points (touch_pair). may_meet: whether points of two boxes can be partners before the next search.
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

#if LANES == 16
// may_meet of sixteen points with one box: a bit for each.
INLINE int meeting_points(vec3 x, vec3 moved, vec3 normal, real spacing, __global const float* b, float margin, float ahead) {
  const real none = 0.0f, wide = b[18], radius = TOUCH_RADIUS, room = margin, steps = ahead;
  const real reach = fma(radius, spacing > wide ? spacing : wide, room), place[3] = {x.x, x.y, x.z}, way[3] = {moved.x, moved.y, moved.z};
  const real direction[3] = {normal.x, normal.y, normal.z};
  real facing = none;
  integer apart = 0;
  for (int c = 0; c < 3; ++c) {
    const real above = b[2 * c] - place[c], rising = way[c] - b[2 * c + 6];
    const real below = place[c] - b[2 * c + 1], falling = b[2 * c + 7] - way[c];
    apart |= above - steps * (rising > 0.0f ? rising : none) > reach;
    apart |= below - steps * (falling > 0.0f ? falling : none) > reach;
    const real l = direction[c] * b[2 * c + 12], h = direction[c] * b[2 * c + 13];
    facing = facing + (l < h ? l : h);
  }
  const integer bits = (apart == 0 && facing < -0.5f) ? (integer)(1) << LANE_INDEX : (integer)(0);
  const int8 eight = bits.lo | bits.hi;
  const int4 four = eight.lo | eight.hi;
  const int2 two = four.lo | four.hi;
  return two.x | two.y;
}
#endif

// Returns 1 for two points of one part that never touch. Otherwise returns 0 and in `offset` their undeformed depth [m].
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
  *offset = gap <= 0.0f ? gap : 0.0f;
  return 0;
}

// Upper bound of the distance between the point of box a and a partner in box b.
static inline float farthest(const float* a, __global const float* b, float margin, float ahead) {
  const float spacing = a[18] > b[18] ? a[18] : b[18];
  float way = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const float rising = a[2 * c + 7] - b[2 * c + 6], falling = b[2 * c + 7] - a[2 * c + 6];
    way = way + (rising > falling ? rising : falling);
  }
  return fma(TOUCH_RADIUS + 2.0f, spacing, fma(ahead, way, margin));
}

// Candidates for partners of one point: LANES others at once.
typedef struct {
  real weight, gap, large;  // 0: no pair; [m]; the larger spacing [m]
} touch_candidates;

// faces: the lanes whose points are near enough and face the point; facing: twice the cosine between its normal and the reversed other one, less 1.
// one_part and the depth of pairs that are new are still to be looked at (keep_partner).
INLINE touch_candidates weigh(integer faces, real facing, integer is_lower, touch_lanes own, touch_lanes other, float own_spacing, real spacing, float margin,
                              float ahead) {
  const real none = 0.0f, one = 1.0f, mine = own_spacing, deepest = -2.0f;
  touch_candidates c;
  c.large = mine > spacing ? mine : spacing;
  lanes_meeting m = begin_meeting(is_lower, own, other);
  end_meeting(is_lower, own, other, &m);
  c.gap = m.gap;
  const vec3 side = times_add(-dot_lanes(m.apart, m.normal), m.normal, m.apart);
  const real radius = TOUCH_RADIUS * c.large, part = dot_lanes(side, side) / (radius * radius);
  const real closing = -dot_lanes(m.moved, m.normal), room = fma((real)(ahead), closing > 0.0f ? closing : none, (real)(margin));
  const real rest = one - part;
  const integer pairs = faces && part < 1.0f && m.gap < room && m.gap > deepest * c.large;
  c.weight = pairs ? (rest * rest) * facing : none;
  return c;
}
