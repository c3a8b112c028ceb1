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

// Returns the weight of a pair; 0: no pair. A new pair starts with its current depth as offset, which is then reduced gradually: a point that slides
// over an edge is suddenly deep, and removing that depth in one step would throw it off. `before`: the offset of a known pair; `ease`: the reduction
// per search, in spacings.
static inline float weight_of(__global const float* touch_place, __global const float* touch_surface, __global const float* touch_rest,
                              __global const int* contact_node, int lower, int upper, int known, float before, float margin,
                              float ahead, float ease, float* offset) {
  const touch_state a = state_of(touch_place, lower), b = state_of(touch_place, upper);
  const float facing = fma(-2.0f, dot_xyz(a.normal, b.normal), -1.0f);
  if (!(facing > 0.0f)) return 0.0f;
  const float one = touch_surface[POINT_BASE(lower, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  const float two = touch_surface[POINT_BASE(upper, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  const float large = one > two ? one : two;
  const touch_meeting m = meeting_of(a, b);
  const float4 side = fma((float4)(-dot_xyz(m.apart, m.normal)), m.normal, m.apart);
  const float radius = TOUCH_RADIUS * large, part = dot_xyz(side, side) / (radius * radius);
  if (!(part < 1.0f)) return 0.0f;
  const float closing = -dot_xyz(a.moved - b.moved, m.normal);
  if (!(m.gap < fma(ahead, closing > 0.0f ? closing : 0.0f, margin))) return 0.0f;
  if (!(m.gap > (known ? -2.0f * large : -large))) return 0.0f;
  if (one_part(touch_surface, touch_rest, contact_node, lower, upper, large, offset)) return 0.0f;
  const float start = known ? fma(ease, large, before) : m.gap;
  *offset = start < *offset ? start : *offset;
  const float rest = 1.0f - part;
  return (rest * rest) * facing;
}
