// Forces of tissue on tissue, second part: repeats touch_press for the pushing pairs at the node positions after contact_apply, with the compliance
// of the touching points. The friction limit applies to the sum of both parts; where a pair slips, its anchor follows. contact_change: the added
// force [quanta] including that of tools (contact_settle), and contact bits.
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"

__kernel void touch_settle(__global const float* touch_place, __global const int* contact_list, __global const int* contact_near, __global int* contact_change,
                           __global const int* touch_partner, __global float* touch_pair, __global const int* touch_force,
                           __global int* touch_moment, __global const float* contact_params) {
  const int first = FIRST_LISTED(contact_list);
  if (first < 0) return;
  const int near = contact_near[first / PLIANT_TILE];
  if (near == 0) return;
  const float quantum = contact_params[0], inverse = contact_params[1], friction = contact_params[7];
  for (int i = first; i < first + LANES; ++i) {
    __global int* change = contact_change + POINT_BASE(i, 4);
    int4 sum = 0;
    float4 lever = 0.0f;
    const touch_state mine = state_of(touch_place, i);
    if ((near & ~PLIANT_TOUCH_BIT) != 0) sum = (int4)(change[0], change[PLIANT_TILE], change[2 * PLIANT_TILE], 0);
    int touching = change[3 * PLIANT_TILE];
    for (int s = 0; s < TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
      const int j = touch_partner[POINT_BASE(i, TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      if (j < 0) break;
      __global const int* own = touch_force + pair_force_base(i, s);
      if (own[3 * PLIANT_TILE] == 0) continue;
      touching |= PLIANT_TOUCH_BIT;
      __global float* numbers = touch_pair + pair_base(i, s);
      const touch_state other = state_of(touch_place, j), lower = i < j ? mine : other, upper = i < j ? other : mine;
      const touch_meeting m = meeting_of(lower, upper);
      const float rest = numbers[PLIANT_TILE] - m.gap, w = lower.yielding + upper.yielding;
      const float stiffness = w > 0.0f ? numbers[0] / w : 0.0f;
      const int4 before = (int4)(own[0], own[PLIANT_TILE], own[2 * PLIANT_TILE], 0);
      const int4 had = i < j ? before : -before;
      const float push = rest > 0.0f ? stiffness * rest : 0.0f;
      float4 f = fma((float4)((float)had.x, (float)had.y, (float)had.z, 0.0f), (float4)(quantum), m.normal * push);
      if (friction > 0.0f) {
        __global float* anchor = numbers + 2 * PLIANT_TILE;
        const float4 side = slip_of(lower, m, three(anchor));
        const float across = dot_xyz(f, m.normal);
        const float4 pull = fma((float4)(-stiffness), side, fma((float4)(-across), m.normal, f));
        const float length = sqrt(dot_xyz(pull, pull)), most = across > 0.0f ? friction * across : 0.0f;
        if (length > most) {
          const float size = sqrt(dot_xyz(side, side)), hold = stiffness > 0.0f ? most / stiffness : 0.0f;
          const float kept = size > hold ? hold / size : 1.0f;
          set_three(anchor, into_frame(lower, fma((float4)(-kept), side, m.apart)));
        }
        f = fma((float4)(length > most ? most / length : 1.0f), pull, m.normal * across);
      }
      lever = fma((float4)(i < j ? push : -push), m.arm, lever);
      int4 q = (int4)(quanta(f.x * inverse), quanta(f.y * inverse), quanta(f.z * inverse), 0);
      if (i > j) q = -q;
      sum += q - before;
    }
    change[0] = sum.x;
    change[PLIANT_TILE] = sum.y;
    change[2 * PLIANT_TILE] = sum.z;
    change[3 * PLIANT_TILE] = touching;
    if ((near & PLIANT_TOUCH_BIT) != 0) set_moment(touch_moment, i, mine, lever, inverse);
  }
}
