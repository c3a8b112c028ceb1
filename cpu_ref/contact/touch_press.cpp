// Twin of kernels/contact/touch_press.cl.
#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

namespace {

using namespace touch;

/// Lowers the offset of a pair where its depth at the start of the step, at the gap `start`, exceeds the limit.
template <class Scalar>
void limit_start(const Place<Scalar>& lower, const Place<Scalar>& upper, Scalar start, Scalar ease, Scalar& offset) {
  const Scalar sparse = lower.density < upper.density ? lower.density : upper.density;
  const Scalar most = start + (Scalar(4) * ease) / sparse;
  if (offset > most) offset = most;
}

/// Friction of a pair towards its anchor, at most `most`; sets the anchor if there is none.
template <class Scalar>
Vec<Scalar> press_friction(const Place<Scalar>& lower, const Pair<Scalar>& p, Scalar* anchor, Scalar stiffness, Scalar most,
                           const Vec<Scalar>& moved, const Vec<Scalar>& f) {
  if (anchor[std::int64_t{3} * PLIANT_TILE] == Scalar(0)) {
    set_three(anchor, 0, 0, into_frame(lower, difference(p.apart, moved)));
    anchor[std::int64_t{3} * PLIANT_TILE] = 1;
  }
  const Vec<Scalar> side = slip_of(lower, p, three(anchor, 0, 0));
  const Scalar length = std::sqrt(dot(side, side));
  return scaled_sum(stiffness * length > most ? -(most / length) : -stiffness, side, f);
}

}  // namespace

template <class Scalar>
void touch_press(Range range, const Scalar* touch_place, const std::int32_t* contact_list, const std::int32_t* contact_near,
                 const Scalar* contact_yield, const std::int32_t* contact_force, std::int32_t* contact_change,
                 const std::int32_t* touch_partner, Scalar* touch_pair, std::int32_t* touch_force, std::int32_t* touch_moment,
                 Scalar* touch_depth, const Scalar* contact_params) {
  const Scalar inverse = contact_params[1], friction = contact_params[7], far = Scalar(0.48) * contact_params[5];
  for (std::int64_t entry = range.begin; entry < range.end; ++entry) {
    const std::int64_t i = listed(contact_list, entry);
    const std::int32_t near = contact_near[i / PLIANT_TILE];
    if (near == 0) continue;
    const auto force = contact::numbers_of(contact_force, i);
    const auto change = contact::numbers_of(contact_change, i);
    Quanta sum{};
    std::int32_t touching = 0;
    const Scalar within = (Scalar(2) * contact::ready_share(contact_yield[i])) * contact_params[5];
    Scalar pressed = 0, inside = 0;
    Vec<Scalar> lever{};
    const Place<Scalar> mine = place_of(touch_place, i);
    if ((near & ~PLIANT_TOUCH_BIT) != 0) {  // the forces of tools
      sum = {force[0], force[1], force[2]};
      touching = force[3];
    }
    for (std::int64_t s = 0; s < PLIANT_TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
      const std::int64_t j = touch_partner[tile_base(i, PLIANT_TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      if (j < 0) break;
      Scalar* numbers = pair_numbers(touch_pair, i, s);
      std::int32_t* own = pair_force(touch_force, i, s);
      own[std::int64_t{3} * PLIANT_TILE] = 0;
      if (!(numbers[0] > Scalar(0))) continue;
      const Place<Scalar> other = place_of(touch_place, j), &lower = i < j ? mine : other, &upper = i < j ? other : mine;
      Scalar *anchor = numbers + std::int64_t{2} * PLIANT_TILE, *stuck = anchor + std::int64_t{3} * PLIANT_TILE;
      const Vec<Scalar> moved = difference(lower.moved, upper.moved);
      const Scalar front = front_of(lower, upper, moved), w = lower.yielding + upper.yielding;
      if (front < within) touching |= PLIANT_READY_BIT;
      const bool meets = front < far && w > Scalar(0);
      const Pair<Scalar> p = meets ? pair_of(lower, upper) : Pair<Scalar>{};
      if (meets) limit_start(lower, upper, dot(difference(p.apart, moved), p.normal), contact_params[8], numbers[PLIANT_TILE]);
      const Scalar depth = numbers[PLIANT_TILE] - p.gap;
      if (!meets || !(depth > Scalar(0))) {
        *stuck = 0;
        continue;
      }
      const Scalar stiffness = numbers[0] / w, push = stiffness * depth, before = dot(moved, p.normal) - p.gap;
      Vec<Scalar> f = times(p.normal, push);
      if (friction > Scalar(0)) f = press_friction(lower, p, anchor, stiffness, friction * push, moved, f);
      lever = scaled_sum(i < j ? push : -push, p.arm, lever);
      const Quanta q = quanta_of(f, inverse, i < j);
      set_three(own, 0, 0, q);
      own[std::int64_t{3} * PLIANT_TILE] = 1;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += q[c];
      touching |= PLIANT_TOUCH_BIT;
      pressed = pressed + numbers[0];
      inside = std::fma(numbers[0], before, inside);
    }
    const Scalar mean = pressed > Scalar(0) ? inside / pressed : Scalar(0);
    touch_depth[i] = mean > touch_depth[i] ? mean : touch_depth[i];
    contact::set_three(change, sum);
    change[3] = touching;
    if ((near & PLIANT_TOUCH_BIT) != 0) set_moment(touch_moment, i, mine, lever, inverse);
  }
}

void register_touch_press(Registry& registry) { registry.add("touch_press", touch_press<float>, touch_press<double>); }

}  // namespace pliant::ref
