// Pairs of LANES points with one partner each (touch_lanes.cl): gaps, frames, slips and moments.
typedef struct {
  vec3 apart, moved, facing;  // lower minus upper position and increment, upper minus lower normal
  vec3 normal;                // direction of the push on the lower point
  vec3 arm;                   // derivative of the gap with respect to the upper normal, and minus that for the lower normal [m]
  real gap;
} lanes_meeting;

// `is_lower`: the own point is the lower one.
INLINE vec3 lower_minus_upper(integer is_lower, vec3 own, vec3 other) { return where(is_lower, sub(own, other), sub(other, own)); }

INLINE lanes_meeting begin_meeting(integer is_lower, touch_lanes own, touch_lanes other) {
  lanes_meeting m;
  m.apart = lower_minus_upper(is_lower, own.x, other.x);
  m.moved = lower_minus_upper(is_lower, own.moved, other.moved);
  m.facing = lower_minus_upper(is_lower, other.normal, own.normal);
  return m;
}
// Upper bound of the distance of the lower point in front of the upper one after the next step, times two because facing normals differ by two.
INLINE real front_of_lanes(lanes_meeting m) {
  const real closing = -dot_lanes(m.moved, m.facing), none = 0.0f;
  return dot_lanes(m.apart, m.facing) - (closing > 0.0f ? closing : none);
}
// A search finds pairs with arms of up to 0.7 spacings (TOUCH_RADIUS over sqrt(3), the least difference of facing normals). A pair that slides on until the
// next search gets a longer one, and the compliance by which its push is divided knows nothing of its moment: heaps of crumpled cloth flew apart. So
// beyond one spacing an arm is as much shorter than that as it was longer.
INLINE void end_meeting(integer is_lower, touch_lanes own, touch_lanes other, lanes_meeting* m) {
  const real length = sqrt(dot_lanes(m->facing, m->facing));
  m->normal = over(m->facing, length);
  const vec3 start = sub(m->apart, m->moved);
  const vec3 arm = times(1.0f / length, times_add(-dot_lanes(start, m->normal), m->normal, start));
  const real sparse = own.density < other.density ? own.density : other.density, longer = dot_lanes(arm, arm) * (sparse * sparse);
  m->arm = where(longer > 1.0f, times(1.0f / longer, arm), arm);
  m->gap = dot_lanes(m->apart, m->normal) + dot_lanes(m->arm, lower_minus_upper(is_lower, other.tilt, own.tilt));
}

// The frame that moves with the lower point.
typedef struct {
  vec3 tangent, across, normal;
} lower_frame;
INLINE lower_frame frame_of_lower(integer is_lower, touch_lanes own, touch_lanes other) {
  lower_frame f;
  f.tangent = where(is_lower, own.tangent, other.tangent);
  f.normal = where(is_lower, own.normal, other.normal);
  f.across = cross_lanes(f.normal, f.tangent);
  return f;
}
INLINE vec3 into_lower(lower_frame f, vec3 v) {
  const vec3 r = {dot_lanes(f.tangent, v), dot_lanes(f.across, v), dot_lanes(f.normal, v)};
  return r;
}
// Tangential slip of a pair relative to its anchor.
INLINE vec3 slip_of_lanes(lower_frame f, lanes_meeting m, vec3 stuck) {
  const vec3 slip = sub(m.apart, times_add(stuck.x, f.tangent, times_add(stuck.y, f.across, times(stuck.z, f.normal))));
  return times_add(-dot_lanes(slip, m.normal), m.normal, slip);
}

// Stores the moments about the first or second tangent.
INLINE void store_moments(__global int* touch_moment, int first, int tangent, quanta3 q) {
#if LANES == 16
  const real none = 0.0f;
  texels_store_rows(AS_REAL(q.x), AS_REAL(q.y), AS_REAL(q.z), none, (__global float*)(touch_moment + PLIANT_TOUCH_MOMENT * first),
                    PLIANT_TOUCH_MOMENT / 4, tangent);
#else
  vstore4((int4)(q.x, q.y, q.z, 0), tangent, touch_moment + PLIANT_TOUCH_MOMENT * first);
#endif
}

// Effect of the pushes on the tangents of points: forces along the normal, divided by the spacing, conjugate to n . F' t_k, in quanta. `lever`: sum of
// the arms of its pairs times their pushes, negated where it is the upper point [N m]. touch_moment: [points][8].
INLINE void set_moments(__global int* touch_moment, int first, touch_lanes own, vec3 lever, float inverse) {
  const integer zero = 0;
  const quanta3 nothing = {zero, zero, zero};
  if (!ANY(lever.x != 0.0f || lever.y != 0.0f || lever.z != 0.0f)) {
    store_moments(touch_moment, first, 0, nothing);
    store_moments(touch_moment, first, 1, nothing);
    return;
  }
  const real across = dot_lanes(lever, cross_lanes(own.normal, own.tangent));
  const real one = fma(-own.skew, across, dot_lanes(lever, own.tangent)) * own.short_first, two = across * own.short_height;
  const quanta3 a = quanta3_of(times(one * own.density, own.normal), inverse), b = quanta3_of(times(two * own.density, own.normal), inverse);
  store_moments(touch_moment, first, 0, a);
  store_moments(touch_moment, first, 1, b);
}
