// Forces of tissue on tissue, second part: repeats touch_press for the pushing pairs at the node positions after contact_apply, with the compliance
// of the touching points. The friction limit applies to the sum of both parts; where a pair slips, its anchor follows. contact_change: the added
// force [quanta] including that of tools (contact_settle), and contact bits; touch_force: the force of both parts.
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_lanes.cl"
#include "touch_meeting.cl"

// The sums over the pairs of a point.
typedef struct {
  quanta3 force;
  integer touching;
  vec3 lever;
} settle_sums;

// Limits the friction of the whole force f; anchors follow pairs that slip.
INLINE vec3 settle_friction(integer pushes, lower_frame frame, lanes_meeting m, real stiffness, float friction, __global float* anchor, vec3 f) {
  const real none = 0.0f, one = 1.0f;
  const vec3 side = slip_of_lanes(frame, m, load3(anchor));
  const real across = dot_lanes(f, m.normal);
  const vec3 pull = times_add(-stiffness, side, times_add(-across, m.normal, f));
  const real length = sqrt(dot_lanes(pull, pull)), most = across > 0.0f ? friction * across : none;
  const integer slips = pushes && length > most;
  if (ANY(slips)) {
    const real size = sqrt(dot_lanes(side, side)), hold = stiffness > 0.0f ? most / stiffness : none;
    const real kept = size > hold ? hold / size : one;
    const vec3 follows = into_lower(frame, times_add(-kept, side, m.apart));
    put_real(slips, follows.x, anchor, 0);
    put_real(slips, follows.y, anchor, 1);
    put_real(slips, follows.z, anchor, 2);
  }
  return times_add(length > most ? most / length : one, pull, times(across, m.normal));
}

// One slot of pairs of the points from `first` on. pushes: the lanes whose pair does.
INLINE void settle_pairs(integer pushes, integer is_lower, touch_lanes mine, __global const float* touch_place, __global const int* partner,
                         __global float* numbers, __global int* own, __global const float* contact_params, settle_sums* sums) {
  const float quantum = contact_params[0], inverse = contact_params[1], friction = contact_params[7];
  const real none = 0.0f;
  const integer zero = 0;
  touch_lanes other;
  load_front(touch_place, partner, &other);
  load_tilt(touch_place, partner, &other);
  lanes_meeting m = begin_meeting(is_lower, mine, other);
  end_meeting(is_lower, mine, other, &m);
  const real rest = LOAD(numbers, PLIANT_TILE) - m.gap, w = mine.yielding + other.yielding;
  const real stiffness = w > 0.0f ? LOAD(numbers, 0) / w : none;
  const quanta3 before = {LOAD(own, 0), LOAD(own, PLIANT_TILE), LOAD(own, 2 * PLIANT_TILE)}, had = negated_where(!is_lower, before);
  const real push = rest > 0.0f ? stiffness * rest : none, unit_of_force = quantum;
  const vec3 was = {TO_REAL(had.x), TO_REAL(had.y), TO_REAL(had.z)};
  const vec3 pushed = times(push, m.normal);
  vec3 f = {fma(was.x, unit_of_force, pushed.x), fma(was.y, unit_of_force, pushed.y), fma(was.z, unit_of_force, pushed.z)};
  if (friction > 0.0f) {
    load_tangent(touch_place, partner, &other);
    f = settle_friction(pushes, frame_of_lower(is_lower, mine, other), m, stiffness, friction, numbers + 2 * PLIANT_TILE, f);
  }
  sums->lever = where(pushes, times_add(is_lower ? push : -push, m.arm, sums->lever), sums->lever);
  const quanta3 q = negated_where(!is_lower, quanta3_of(f, inverse));
  sums->force.x += pick(pushes, q.x - before.x, zero);
  sums->force.y += pick(pushes, q.y - before.y, zero);
  sums->force.z += pick(pushes, q.z - before.z, zero);
  put(pushes, q.x, own, 0);
  put(pushes, q.y, own, 1);
  put(pushes, q.z, own, 2);
}

__kernel void touch_settle(__global const float* touch_place, __global const int* contact_list, __global const int* contact_near, __global int* contact_change,
                           __global const int* touch_partner, __global float* touch_pair, __global int* touch_force,
                           __global int* touch_moment, __global const float* contact_params) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const real none = 0.0f;
  const integer zero = 0, i = first + LANE_INDEX;
  const touch_lanes mine = own_lanes(touch_place, first);
  __global int* change = contact_change + POINT_BASE(first, 4);
  settle_sums sums = {{zero, zero, zero}, LOAD(change, 3 * PLIANT_TILE), {none, none, none}};
  if ((near & ~PLIANT_TOUCH_BIT) != 0) {
    sums.force.x = LOAD(change, 0);
    sums.force.y = LOAD(change, PLIANT_TILE);
    sums.force.z = LOAD(change, 2 * PLIANT_TILE);
  }
  for (int s = 0; s < TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
    __global const int* partner = touch_partner + POINT_BASE(first, TOUCH_SLOTS) + s * PLIANT_TILE;
    const integer j = LOAD(partner, 0) - 1, used = j >= 0;
    if (!ANY(used)) break;
    __global int* own = touch_force + pair_force_base(first, s);
    const integer pushes = used && LOAD(own, 3 * PLIANT_TILE) != 0;
    if (!ANY(pushes)) continue;
    sums.touching |= pick(pushes, (integer)(PLIANT_TOUCH_BIT), zero);
    settle_pairs(pushes, i < j, mine, touch_place, partner, touch_pair + pair_base(first, s), own, contact_params, &sums);
  }
  STORE(sums.force.x, change, 0);
  STORE(sums.force.y, change, PLIANT_TILE);
  STORE(sums.force.z, change, 2 * PLIANT_TILE);
  STORE(sums.touching, change, 3 * PLIANT_TILE);
  if ((near & PLIANT_TOUCH_BIT) != 0) set_moments(touch_moment, first, mine, sums.lever, contact_params[1]);
}
