// Contact of tissue with tissue: contact points (contact_point.cl) of both sides represent surface patches and form pairs. Both points of a pair
// compute its force in the same order of operations (`lower`: the point with the lower index). So action equals reaction to the last bit, and each
// point writes only its own data.
//   A pair is pushed along normal = unit(n_upper - n_lower); its gap is g = (x_lower - x_upper) . normal. For two touching surfaces with curvatures k
//   and tangential positions s this is the gap between them at the mean position up to O(s^3), so the polygonal surface is not felt.
//   Normals follow the deformed surface: n ~ F t1 x F t2 with the undeformed tangents t1 and t2.
// touch_surface: [tiles][24][16] weights of F t1 (8) and F t2 (8) [1/m], t1 (3), t2 (3), spacing of the points around, extent of the patch [m].
// touch_rest: [tiles][4][16] undeformed position shifted by RunState::offset (3) [m], body.
//   The gap also depends on the rotation of the normals: a pair pushes its points apart and rotates their tangents so that the push has no moment
//   (touch_moment). The push is then the gradient of an energy; without this, frictionless contact would add energy indefinitely.
//   Normals, tangents and arms are those of the start of the step (see contact_point.cl).
// touch_place: [points][20] (position [m], W [m/(N/m^2)] of contact_press), (increment [m], 1 / |F t1|), (normal, skew of F t2), (F t1 / |F t1|,
// 1 / height of F t2), (change of the normal in the step, 1 / spacing): one row per point, because partners read it in random order.
// touch_partner: [tiles][16 slots][16] other point + 1, 0: none; touch_pair: [tiles][16 slots][6][16] (kernels/layout.h).
#define TOUCH_SLOTS PLIANT_TOUCH_SLOTS
#define TOUCH_RADIUS 1.2f  // search radius of a pair, in spacings; on a grid, the next point is at most 0.71 away

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
  float4 x, moved, normal, tangent, tilt;  // tilt: change of the normal in the step
  float yielding, density;                 // compliance W, and density of points: 1 / spacing [1/m]
  float short_first, skew, short_height;   // of the tangents: 1 / |F t1|, skew of F t2, 1 / height of F t2 over F t1
} touch_state;

static inline touch_state state_of(__global const float* touch_place, int i) {
  __global const float* at = touch_place + PLIANT_TOUCH_PLACE * i;
  touch_state s;
  s.x = vload4(0, at);
  s.moved = vload4(1, at);
  s.normal = vload4(2, at);
  s.tangent = vload4(3, at);
  s.tilt = vload4(4, at);
  s.yielding = s.x.w;
  s.short_first = s.moved.w;
  s.skew = s.normal.w;
  s.short_height = s.tangent.w;
  s.density = s.tilt.w;
  s.x.w = s.moved.w = s.normal.w = s.tangent.w = s.tilt.w = 0.0f;
  return s;
}

typedef struct {
  float4 apart, normal;  // lower minus upper position; direction of the push on the lower point
  float4 arm;            // derivative of the gap with respect to the upper normal, and minus that for the lower normal [m]
  float gap;
} touch_meeting;

// Upper bound of the distance of the lower point in front of the upper one after the next step, times two because facing normals differ by two.
static inline float front_of(touch_state lower, touch_state upper, float4 moved) {
  const float4 facing = upper.normal - lower.normal;
  const float closing = -dot_xyz(moved, facing);
  return dot_xyz(lower.x - upper.x, facing) - (closing > 0.0f ? closing : 0.0f);
}

static inline touch_meeting meeting_of(touch_state lower, touch_state upper) {
  touch_meeting m;
  m.apart = lower.x - upper.x;
  const float4 facing = upper.normal - lower.normal;
  const float length = sqrt(dot_xyz(facing, facing));
  m.normal = normalised(facing.x, facing.y, facing.z, length);
  const float4 start = m.apart - (lower.moved - upper.moved);
  m.arm = fma((float4)(-dot_xyz(start, m.normal)), m.normal, start) * (1.0f / length);
  m.gap = dot_xyz(m.apart, m.normal) + dot_xyz(m.arm, upper.tilt - lower.tilt);
  return m;
}

// Effect of the pushes on the tangents of a point: forces along the normal, divided by the spacing, conjugate to n . F' t_k, in quanta. `lever`: sum
// of the arms of its pairs times their pushes, negated where it is the upper point [N m].
static inline void set_moment(__global int* touch_moment, int i, touch_state own, float4 lever, float inverse) {
  const float across = dot_xyz(lever, cross3(own.normal, own.tangent));
  const float first = fma(-own.skew, across, dot_xyz(lever, own.tangent)) * own.short_first, second = across * own.short_height;
  __global int* moment = touch_moment + POINT_BASE(i, PLIANT_TOUCH_MOMENT);
  const float4 one = own.normal * (first * own.density), two = own.normal * (second * own.density);
  moment[0] = quanta(one.x * inverse);
  moment[PLIANT_TILE] = quanta(one.y * inverse);
  moment[2 * PLIANT_TILE] = quanta(one.z * inverse);
  moment[3 * PLIANT_TILE] = quanta(two.x * inverse);
  moment[4 * PLIANT_TILE] = quanta(two.y * inverse);
  moment[5 * PLIANT_TILE] = quanta(two.z * inverse);
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

// Tangential slip of a pair relative to its anchor.
static inline float4 slip_of(touch_state lower, touch_meeting m, float4 stuck) {
  const float4 slip = m.apart - out_of_frame(lower, stuck);
  return fma((float4)(-dot_xyz(slip, m.normal)), m.normal, slip);
}
