// After a search (touch_pair): the area of each pair, A_i A_j w_ij / max(S_i, S_j) with S_i = sum_j A_j w_ij, so that the pairs of a point share at
// most its own area. A pair exists if both points have each other as partner; otherwise its anchor is cleared.
#include "arith.cl"
#include "contact_shape.cl"
#include "contact_point.cl"
#include "touch_point.cl"

__kernel void touch_share(__global const float* contact_rest, __global const int* contact_near, __global const int* touch_partner,
                          __global const float* touch_weight, __global float* touch_pair) {
  const int first = FIRST_INDEX;
  if ((contact_near[first / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) return;
  for (int i = first; i < first + LANES; ++i) {
    __global const float* weight = touch_weight + POINT_BASE(i, TOUCH_SLOTS + 1);
    for (int s = 0; s < TOUCH_SLOTS; ++s) {
      const int j = touch_partner[POINT_BASE(i, TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      float area = 0.0f;
      if (j >= 0) {
        int back = 0;
        while (back < TOUCH_SLOTS && touch_partner[POINT_BASE(j, TOUCH_SLOTS) + back * PLIANT_TILE] != i + 1) ++back;
        if (back < TOUCH_SLOTS) {
          const float one = weight[TOUCH_SLOTS * PLIANT_TILE];
          const float two = touch_weight[POINT_BASE(j, TOUCH_SLOTS + 1) + TOUCH_SLOTS * PLIANT_TILE];
          const float both = contact_rest[POINT_BASE(i, 4) + 3 * PLIANT_TILE] * contact_rest[POINT_BASE(j, 4) + 3 * PLIANT_TILE];
          area = both * (weight[s * PLIANT_TILE] / (one > two ? one : two));
        }
      }
      __global float* numbers = touch_pair + pair_base(i, s);
      numbers[0] = area;
      if (!(area > 0.0f)) numbers[5 * PLIANT_TILE] = 0.0f;
    }
  }
}
