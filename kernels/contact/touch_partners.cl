// Search for pairs of contact points (touch_pair): the partners of one point among those of a tile.

// The partners of a point, as they are found.
typedef struct {
  int old[TOUCH_SLOTS];
  float kept[TOUCH_SLOTS][PLIANT_TOUCH_PAIR];
  int known, filled;
} touch_partners;

// Keeps what was known of the partners of point i, and clears its slots.
static inline void begin_partners(touch_partners* p, int i, __global int* touch_partner, __global const float* touch_pair, __global float* touch_weight) {
  __global int* partner = touch_partner + POINT_BASE(i, TOUCH_SLOTS);
  __global float* weight = touch_weight + POINT_BASE(i, TOUCH_SLOTS + 1);
  p->filled = 0;
  for (p->known = 0; p->known < TOUCH_SLOTS; ++p->known) {
    const int s = p->known;
    p->old[s] = partner[s * PLIANT_TILE];
    if (p->old[s] == 0) break;  // used slots come first
    for (int c = 0; c < PLIANT_TOUCH_PAIR; ++c) p->kept[s][c] = touch_pair[pair_base(i, s) + c * PLIANT_TILE];
    partner[s * PLIANT_TILE] = 0;
    weight[s * PLIANT_TILE] = 0.0f;
  }
  weight[TOUCH_SLOTS * PLIANT_TILE] = 0.0f;
}

// Takes point j as a partner of i, with weight w. A new pair starts with its current depth as offset, which is then reduced gradually: a point that
// slides over an edge is suddenly deep, and removing that depth in one step would throw it off. `ease`: the reduction per search, in spacings.
static inline void keep_partner(touch_partners* p, int i, int j, float w, float gap, float large, float ease, __global const float* touch_surface,
                                __global const float* touch_rest, __global const int* contact_node, __global int* touch_partner,
                                __global float* touch_pair, __global float* touch_weight) {
  int before = 0;
  while (before < p->known && p->old[before] != j + 1) ++before;
  const int known = before < p->known && p->kept[before][0] > 0.0f;  // partners of each other before
  if (!known && !(gap > -large)) return;
  float offset;
  if (one_part(touch_surface, touch_rest, contact_node, i < j ? i : j, i < j ? j : i, large, &offset)) return;
  const float start = known ? fma(ease, large, p->kept[before][1]) : gap;
  offset = start < offset ? start : offset;
  __global int* partner = touch_partner + POINT_BASE(i, TOUCH_SLOTS);
  __global float* weight = touch_weight + POINT_BASE(i, TOUCH_SLOTS + 1);
  int slot = p->filled;
  if (slot == TOUCH_SLOTS) {
    slot = 0;
    for (int s = 1; s < TOUCH_SLOTS; ++s) slot = weight[s * PLIANT_TILE] < weight[slot * PLIANT_TILE] ? s : slot;
    if (!(w > weight[slot * PLIANT_TILE])) return;
  } else {
    ++p->filled;
  }
  partner[slot * PLIANT_TILE] = j + 1;
  weight[slot * PLIANT_TILE] = w;
  __global float* numbers = touch_pair + pair_base(i, slot);
  numbers[PLIANT_TILE] = offset;
  for (int c = 2; c < PLIANT_TOUCH_PAIR; ++c) numbers[c * PLIANT_TILE] = known ? p->kept[before][c] : 0.0f;
}

INLINE vec3 same(float x, float y, float z) {
  const vec3 r = {SAME(x), SAME(y), SAME(z)};
  return r;
}
// The state of point i in all lanes.
INLINE touch_lanes same_lanes(__global const float* touch_place, int i) {
  __global const float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  const touch_lanes s = {same(at[0], at[1], at[2]),    same(at[4], at[5], at[6]),    same(at[8], at[9], at[10]), same(at[12], at[13], at[14]),
                         same(at[16], at[17], at[18]), SAME(at[3]), SAME(at[19]), SAME(at[7]), SAME(at[11]), SAME(at[15])};
  return s;
}

// Looks for partners of point i among those of a tile.
static inline void try_tile(touch_partners* p, int i, int tile, float far, float own_spacing, float margin, float ahead, float ease,
                            __global const float* touch_place, __global const float* touch_surface, __global const float* touch_rest,
                            __global const int* contact_node, __global int* touch_partner, __global float* touch_pair,
                            __global float* touch_weight) {
  __global const float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  for (int first = tile * PLIANT_TILE; first < (tile + 1) * PLIANT_TILE; first += LANES) {
    const vec3 x = xyz(own_texels(touch_place, first, 0)), away = sub(x, same(at[0], at[1], at[2]));
    const real spacing = LOAD(touch_surface, POINT_BASE(first, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE);
    const integer j = first + LANE_INDEX, near = dot_lanes(away, away) < far * far && j != i && spacing > 0.0f;
    if (!ANY(near)) continue;
    const real facing = fma(SAME(-2.0f), dot_lanes(same(at[8], at[9], at[10]), xyz(own_texels(touch_place, first, 2))), SAME(-1.0f));
    const integer faces = near && facing > 0.0f;
    if (!ANY(faces)) continue;  // most are of the same surface
    const touch_candidates c =
        weigh(faces, facing, i < j, same_lanes(touch_place, i), own_lanes(touch_place, first), own_spacing, spacing, margin, ahead);
    if (!ANY(c.weight > 0.0f)) continue;
    for (int l = 0; l < LANES; ++l) {
      if (!(LANE(c.weight, l) > 0.0f)) continue;
      keep_partner(p, i, first + l, LANE(c.weight, l), LANE(c.gap, l), LANE(c.large, l), ease, touch_surface, touch_rest, contact_node, touch_partner,
                   touch_pair, touch_weight);
    }
  }
}
