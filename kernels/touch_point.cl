// Tissue that touches tissue: contact points (contact_point.cl) of both sides are patches of surface, in pairs. What a pair does is
// computed by both of its points, in the same order of operations (`lower`: the point with the lower index), so that action is
// reaction to the last bit and nobody writes but to himself.
//   Pushed along normal = unit(n_upper - n_lower), the gap is g = (x_lower - x_upper) . normal. For two touching surfaces with curvatures k
//   and tangential places s this is the gap between them at the mean place but for O(s^3): no polygon is felt.
//   Normals follow the deformed surface: n ~ F t1 x F t2, t1 and t2 the tangents at rest.
// touch_surface: [tiles][24][16] weights of F t1 (8) and F t2 (8) [1/m], t1 (3), t2 (3), spacing of the points around [m].
// touch_rest: [tiles][4][16] place at rest without what loose pieces have flown (3) [m], body.
// touch_place: [points][16] (place [m], W [m/(N/m^2)] of contact_press), (increment [m], 0), (normal, 0), (F t1 / |F t1|, 0): a row per
// point, because partners read it in no order.
// touch_partner: [tiles][16 slots][16] other point + 1, 0: none; touch_pair: [tiles][16 slots][6][16] (kernels/layout.h).
#define TOUCH_SLOTS PLIANT_TOUCH_SLOTS
#define TOUCH_EASE 0.04f   // of an offset, in spacings per look
#define TOUCH_RADIUS 1.2f  // of a pair, in spacings; a point is at most 0.71 from the next on a grid

static inline float4 three(__global const float* at) { return (float4)(at[0], at[PLIANT_TILE], at[2 * PLIANT_TILE], 0.0f); }
static inline void set_three(__global float* at, float4 v) {
  at[0] = v.x;
  at[PLIANT_TILE] = v.y;
  at[2 * PLIANT_TILE] = v.z;
}

static inline float4 cross3(float4 a, float4 b) {
  return (float4)(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x)), 0.0f);
}
static inline float4 unit(float4 v) { return normalised(v.x, v.y, v.z, sqrt(dot_xyz(v, v))); }

typedef struct {
  float4 x, moved, normal, tangent;
  float yielding;
} touch_state;

static inline touch_state state_of(__global const float* touch_place, int i) {
  __global const float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  touch_state s;
  s.x = vload4(0, at);
  s.yielding = s.x.w;
  s.x.w = 0.0f;
  s.moved = vload4(1, at);
  s.normal = vload4(2, at);
  s.tangent = vload4(3, at);
  return s;
}

// Place, increment and, unless `again`, the frame of a point. W is left to others.
static inline void write_place(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                               __global const int* contact_node, __global const float* contact_weight,
                               __global const float* touch_surface, __global float* touch_place, int i, int again) {
  const contact_place p = place_of_point(node_u, node_w, contact_rest, contact_node, contact_weight, i);
  __global float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  at[0] = p.now.x;
  at[1] = p.now.y;
  at[2] = p.now.z;
  vstore4((float4)(p.moved.x, p.moved.y, p.moved.z, 0.0f), 1, at);
  if (again != 0) return;
  __global const float* own = touch_surface + POINT_BASE(i, PLIANT_TOUCH_SURFACE);
  __global const int* node = contact_node + POINT_BASE(i, 8);
  float4 first = three(own + 16 * PLIANT_TILE), second = three(own + 19 * PLIANT_TILE);
  for (int a = 0; a < 8; ++a) {
    const float4 u = vload4(node[a * PLIANT_TILE], node_u);
    first = fma((float4)(own[a * PLIANT_TILE]), u, first);
    second = fma((float4)(own[(8 + a) * PLIANT_TILE]), u, second);
  }
  vstore4(unit(cross3(first, second)), 2, at);
  vstore4(unit(first), 3, at);
}

typedef struct {
  float4 apart, normal;  // lower minus upper; what pushes the lower one
  float gap;
} touch_meeting;

// Whether the second lies behind the first: of two points in front of each other nothing else need be computed.
static inline int may_push(touch_state lower, touch_state upper) {
  return dot_xyz(lower.x - upper.x, upper.normal - lower.normal) < 0.0f;
}

static inline touch_meeting meeting_of(touch_state lower, touch_state upper) {
  touch_meeting m;
  m.apart = lower.x - upper.x;
  m.normal = unit(upper.normal - lower.normal);
  m.gap = dot_xyz(m.apart, m.normal);
  return m;
}

// The frame that moves with the lower point.
static inline float4 into_frame(touch_state lower, float4 v) {
  return (float4)(dot_xyz(lower.tangent, v), dot_xyz(cross3(lower.normal, lower.tangent), v), dot_xyz(lower.normal, v), 0.0f);
}
static inline float4 out_of_frame(touch_state lower, float4 v) {
  const float4 along = lower.normal * v.z;
  return fma((float4)(v.x), lower.tangent, fma((float4)(v.y), cross3(lower.normal, lower.tangent), along));
}

static inline int pair_base(int i, int slot) {
  return POINT_BASE(i, TOUCH_SLOTS * PLIANT_TOUCH_PAIR) + slot * PLIANT_TOUCH_PAIR * PLIANT_TILE;
}
static inline int pair_force_base(int i, int slot) {
  return POINT_BASE(i, TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + slot * PLIANT_TOUCH_FORCE * PLIANT_TILE;
}

// Slip of a pair against where it stuck, along the surface.
static inline float4 slip_of(touch_state lower, touch_meeting m, float4 stuck) {
  const float4 slip = m.apart - out_of_frame(lower, stuck);
  return fma((float4)(-dot_xyz(slip, m.normal)), m.normal, slip);
}
