// Forces of tissue on tissue, first part, after the trial step. The depth d of a pair of area a is removed by
//   f = a d / (W_i + W_j),
// which bounds a row of the compliance matrix of all pairs (Gershgorin; contact_press): any number of pairs is stable, and contact does not limit the
// step. A pair that is deep at the start of a step, although the step before took its depth back, got it from its normals: those of a crushed face turn
// far in a step. Taken back at once, that would throw its points off (as in touch_meet.cl), so it becomes part of the pair's offset.
// Friction pulls a pair towards its anchor in the frame of its lower point, with at most mu f. contact_change: the force (3) [quanta] including
// that of tools (contact_force), and contact bits; touch_force: [tiles][16 slots][4][16] force of each pair (3) [quanta], whether it pushes;
// touch_depth: [points] largest depth of a point inside its partners, averaged over their area, at the start of a step since the last read by the
// host [m].
#include "arith.cl"
#include "texels.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"
#include "touch_lanes.cl"
#include "touch_meeting.cl"

#define TOUCH_START 4.0f  // [ease of an offset] largest depth at the start of a step, a sixth of a spacing at most

// The sums over the pairs of a point.
typedef struct {
  quanta3 force;
  integer touching;
  real pressed, inside;
  vec3 lever;
} press_sums;

// Friction of pairs towards their anchors, at most `most`, added to `f`; anchors are set where there are none.
INLINE vec3 press_friction(integer pushes, lower_frame frame, lanes_meeting m, real stiffness, real most, __global float* anchor, vec3 f) {
  const integer fresh = LOAD(anchor, 3 * PLIANT_TILE) == 0.0f;
  const vec3 begins = into_lower(frame, sub(m.apart, m.moved)), stuck = where(fresh, begins, load3(anchor));
  const real one = 1.0f;
  put_real(pushes && fresh, begins.x, anchor, 0);
  put_real(pushes && fresh, begins.y, anchor, 1);
  put_real(pushes && fresh, begins.z, anchor, 2);
  put_real(pushes && fresh, one, anchor, 3);
  const vec3 side = slip_of_lanes(frame, m, stuck);
  const real length = sqrt(dot_lanes(side, side));
  return times_add(stiffness * length > most ? -(most / length) : -stiffness, side, f);
}

// One slot of pairs of the points from `first` on. used: the lanes that have one.
INLINE void press_pairs(integer used, integer is_lower, touch_lanes mine, __global const float* touch_place, __global const int* partner,
                        __global float* numbers, __global int* own, real within, __global const float* contact_params, press_sums* sums) {
  const float inverse = contact_params[1], friction = contact_params[7], far = 0.48f * contact_params[5];
  const real none = 0.0f, area = LOAD(numbers, 0);
  const integer zero = 0, one = 1, pairs = used && area > 0.0f;
  put(used, zero, own, 3);
  if (!ANY(pairs)) return;
  __global float* anchor = numbers + 2 * PLIANT_TILE;
  touch_lanes other;
  load_front(touch_place, partner, &other);
  lanes_meeting m = begin_meeting(is_lower, mine, other);
  const real front = front_of_lanes(m), w = mine.yielding + other.yielding;
  sums->touching |= pick(pairs && front < within, (integer)(PLIANT_READY_BIT), zero);
  const integer meets = pairs && front < far && w > 0.0f;
  if (!ANY(meets)) {
    put_real(pairs, none, anchor, 3);
    return;
  }
  load_tilt(touch_place, partner, &other);
  end_meeting(is_lower, mine, other, &m);
  const real sparse = mine.density < other.density ? mine.density : other.density, offset = LOAD(numbers, PLIANT_TILE);
  const real most = dot_lanes(sub(m.apart, m.moved), m.normal) + (TOUCH_START * contact_params[8]) / sparse;
  const real kept = meets && offset > most ? most : offset;
  STORE(kept, numbers, PLIANT_TILE);
  const real depth = kept - m.gap;
  const integer pushes = meets && depth > 0.0f;
  put_real(pairs && !pushes, none, anchor, 3);
  if (!ANY(pushes)) return;
  const real stiffness = area / w, push = stiffness * depth, before = dot_lanes(m.moved, m.normal) - m.gap;
  vec3 f = times(push, m.normal);
  if (friction > 0.0f) {
    load_tangent(touch_place, partner, &other);
    f = press_friction(pushes, frame_of_lower(is_lower, mine, other), m, stiffness, friction * push, anchor, f);
  }
  sums->lever = where(pushes, times_add(is_lower ? push : -push, m.arm, sums->lever), sums->lever);
  const quanta3 q = negated_where(!is_lower, quanta3_of(f, inverse));
  put(pushes, q.x, own, 0);
  put(pushes, q.y, own, 1);
  put(pushes, q.z, own, 2);
  put(pushes, one, own, 3);
  sums->force.x += pick(pushes, q.x, zero);
  sums->force.y += pick(pushes, q.y, zero);
  sums->force.z += pick(pushes, q.z, zero);
  sums->touching |= pick(pushes, (integer)(PLIANT_TOUCH_BIT), zero);
  sums->pressed = pushes ? sums->pressed + area : sums->pressed;
  sums->inside = pushes ? fma(area, before, sums->inside) : sums->inside;
}

__kernel void touch_press(__global const float* touch_place, __global const int* contact_list, __global const int* contact_near, __global const float* contact_yield,
                          __global const int* contact_force,
                          __global int* contact_change, __global const int* touch_partner, __global float* touch_pair,
                          __global int* touch_force, __global int* touch_moment, __global float* touch_depth, __global const float* contact_params) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const real none = 0.0f, yield = LOAD(contact_yield, first), again = READY_AGAIN, fresh = READY_NEW;
  const real within = (2.0f * (yield > 0.0f ? again : fresh)) * contact_params[5];  // may_touch_next
  const integer zero = 0, i = first + LANE_INDEX;
  const touch_lanes mine = own_lanes(touch_place, first);
  press_sums sums = {{zero, zero, zero}, zero, none, none, {none, none, none}};
  if ((near & ~PLIANT_TOUCH_BIT) != 0) {  // the forces of tools
    __global const int* force = contact_force + POINT_BASE(first, 4);
    sums.force.x = LOAD(force, 0);
    sums.force.y = LOAD(force, PLIANT_TILE);
    sums.force.z = LOAD(force, 2 * PLIANT_TILE);
    sums.touching = LOAD(force, 3 * PLIANT_TILE);
  }
  for (int s = 0; s < TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
    __global const int* partner = touch_partner + POINT_BASE(first, TOUCH_SLOTS) + s * PLIANT_TILE;
    const integer j = LOAD(partner, 0) - 1, used = j >= 0;
    if (!ANY(used)) break;  // used slots come first
    press_pairs(used, i < j, mine, touch_place, partner, touch_pair + pair_base(first, s), touch_force + pair_force_base(first, s), within,
                contact_params, &sums);
  }
  const real mean = sums.pressed > 0.0f ? sums.inside / sums.pressed : none, deepest = LOAD(touch_depth, first);
  STORE(mean > deepest ? mean : deepest, touch_depth, first);
  __global int* change = contact_change + POINT_BASE(first, 4);
  STORE(sums.force.x, change, 0);
  STORE(sums.force.y, change, PLIANT_TILE);
  STORE(sums.force.z, change, 2 * PLIANT_TILE);
  STORE(sums.touching, change, 3 * PLIANT_TILE);
  if ((near & PLIANT_TOUCH_BIT) != 0) set_moments(touch_moment, first, mine, sums.lever, contact_params[1]);
}
