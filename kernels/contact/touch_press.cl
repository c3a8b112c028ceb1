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
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"

#define TOUCH_START 4.0f  // [ease of an offset] largest depth at the start of a step, a sixth of a spacing at most

__kernel void touch_press(__global const float* touch_place, __global const int* contact_list, __global const int* contact_near, __global const float* contact_yield,
                          __global const int* contact_force,
                          __global int* contact_change, __global const int* touch_partner, __global float* touch_pair,
                          __global int* touch_force, __global int* touch_moment, __global float* touch_depth, __global const float* contact_params) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const float inverse = contact_params[1], friction = contact_params[7];
  for (int i = first; i < first + LANES; ++i) {
    __global const int* force = contact_force + POINT_BASE(i, 4);
    __global int* change = contact_change + POINT_BASE(i, 4);
    int4 sum = 0;
    int touching = 0;
    const float far = 0.48f * contact_params[5], within = (2.0f * ready_share(contact_yield[i])) * contact_params[5];
    float pressed = 0.0f, inside = 0.0f;
    float4 lever = 0.0f;
    const touch_state mine = state_of(touch_place, i);
    if ((near & ~PLIANT_TOUCH_BIT) != 0) {  // the forces of tools
      sum = (int4)(force[0], force[PLIANT_TILE], force[2 * PLIANT_TILE], 0);
      touching = force[3 * PLIANT_TILE];
    }
    for (int s = 0; s < TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
      const int j = touch_partner[POINT_BASE(i, TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      if (j < 0) break;  // used slots come first
      __global float* numbers = touch_pair + pair_base(i, s);
      __global int* own = touch_force + pair_force_base(i, s);
      own[3 * PLIANT_TILE] = 0;
      if (!(numbers[0] > 0.0f)) continue;
      const touch_state other = state_of(touch_place, j), lower = i < j ? mine : other, upper = i < j ? other : mine;
      const float w = lower.yielding + upper.yielding;
      __global float* anchor = numbers + 2 * PLIANT_TILE;
      const float4 moved = lower.moved - upper.moved;
      const float front = front_of(lower, upper, moved);
      if (front < within) touching |= PLIANT_READY_BIT;
      if (!(front < far) || !(w > 0.0f)) {
        anchor[3 * PLIANT_TILE] = 0.0f;
        continue;
      }
      const touch_meeting m = meeting_of(lower, upper);
      const float sparse = lower.density < upper.density ? lower.density : upper.density;
      const float most = dot_xyz(m.apart - moved, m.normal) + (TOUCH_START * contact_params[8]) / sparse;
      if (numbers[PLIANT_TILE] > most) numbers[PLIANT_TILE] = most;
      const float depth = numbers[PLIANT_TILE] - m.gap;
      if (!(depth > 0.0f)) {
        anchor[3 * PLIANT_TILE] = 0.0f;
        continue;
      }
      const float stiffness = numbers[0] / w, push = stiffness * depth, before = dot_xyz(moved, m.normal) - m.gap;
      float4 f = m.normal * push;
      if (friction > 0.0f) {
        if (anchor[3 * PLIANT_TILE] == 0.0f) {
          set_three(anchor, into_frame(lower, m.apart - moved));
          anchor[3 * PLIANT_TILE] = 1.0f;
        }
        const float4 side = slip_of(lower, m, three(anchor));
        const float length = sqrt(dot_xyz(side, side)), most = friction * push;
        f = fma((float4)(stiffness * length > most ? -(most / length) : -stiffness), side, f);
      }
      lever = fma((float4)(i < j ? push : -push), m.arm, lever);
      int4 q = (int4)(quanta(f.x * inverse), quanta(f.y * inverse), quanta(f.z * inverse), 0);
      if (i > j) q = -q;
      own[0] = q.x;
      own[PLIANT_TILE] = q.y;
      own[2 * PLIANT_TILE] = q.z;
      own[3 * PLIANT_TILE] = 1;
      sum += q;
      touching |= PLIANT_TOUCH_BIT;
      pressed = pressed + numbers[0];
      inside = fma(numbers[0], before, inside);
    }
    const float mean = pressed > 0.0f ? inside / pressed : 0.0f;
    touch_depth[i] = mean > touch_depth[i] ? mean : touch_depth[i];
    change[0] = sum.x;
    change[PLIANT_TILE] = sum.y;
    change[2 * PLIANT_TILE] = sum.z;
    change[3 * PLIANT_TILE] = touching;
    if ((near & PLIANT_TOUCH_BIT) != 0) set_moment(touch_moment, i, mine, lever, inverse);
  }
}
