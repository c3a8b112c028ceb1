// Twin of kernels/contact/touch_settle.cl.
#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace touch;

/// `f`: the normal force so far and the friction of the first part. Returns it with admissible friction, and moves the anchor
/// where the pair slips.
template <class Scalar>
Vec<Scalar> settle_friction(const Place<Scalar>& lower, const Pair<Scalar>& p, Scalar* anchor, Scalar stiffness,
                            Scalar friction, const Vec<Scalar>& f) {
  const Vec<Scalar> side = slip_of(lower, p, three(anchor, 0, 0));
  const Scalar across = dot(f, p.normal);
  const Vec<Scalar> pull = scaled_sum(-stiffness, side, scaled_sum(minus(across), p.normal, f));
  const Scalar length = std::sqrt(dot(pull, pull)), most = across > Scalar(0) ? friction * across : Scalar(0);
  if (length > most) {
    const Scalar size = std::sqrt(dot(side, side)), hold = stiffness > Scalar(0) ? most / stiffness : Scalar(0);
    const Scalar kept = size > hold ? hold / size : Scalar(1);
    set_three(anchor, 0, 0, into_frame(lower, scaled_sum(-kept, side, p.apart)));
  }
  return scaled_sum(length > most ? most / length : Scalar(1), pull, times(p.normal, across));
}

}  // namespace

template <class Scalar>
void touch_settle(Range range, const Scalar* touch_place, const std::int32_t* contact_list, const std::int32_t* contact_near,
                  std::int32_t* contact_change, const std::int32_t* touch_partner, Scalar* touch_pair,
                  const std::int32_t* touch_force, std::int32_t* touch_moment, const Scalar* contact_params) {
  const Scalar quantum = contact_params[0], inverse = contact_params[1], friction = contact_params[7];
  for (std::int64_t entry = range.begin; entry < range.end; ++entry) {
    const std::int64_t i = listed(contact_list, entry);
    const std::int32_t near = contact_near[i / PLIANT_TILE];
    if (near == 0) continue;
    const auto change = contact::numbers_of(contact_change, i);
    Quanta sum{};
    Vec<Scalar> lever{};
    const Place<Scalar> mine = place_of(touch_place, i);
    if ((near & ~PLIANT_TOUCH_BIT) != 0) sum = {change[0], change[1], change[2]};  // the forces of tools
    std::int32_t touching = change[3];
    for (std::int64_t s = 0; s < PLIANT_TOUCH_SLOTS && (near & PLIANT_TOUCH_BIT) != 0; ++s) {
      const std::int64_t j = touch_partner[tile_base(i, PLIANT_TOUCH_SLOTS) + s * PLIANT_TILE] - 1;
      if (j < 0) break;
      const std::int32_t* own = pair_force(touch_force, i, s);
      if (own[std::int64_t{3} * PLIANT_TILE] == 0) continue;
      touching |= PLIANT_TOUCH_BIT;
      Scalar* numbers = pair_numbers(touch_pair, i, s);
      const Place<Scalar> other = place_of(touch_place, j);
      const Place<Scalar>&lower = i < j ? mine : other, &upper = i < j ? other : mine;
      const Pair<Scalar> p = pair_of(lower, upper);
      const Scalar rest = numbers[PLIANT_TILE] - p.gap, w = lower.yielding + upper.yielding;
      const Scalar stiffness = w > Scalar(0) ? numbers[0] / w : Scalar(0);
      const Quanta before = three(own, 0, 0);
      Vec<Scalar> had{};
      for (std::size_t c = 0; c < 3; ++c) had[c] = static_cast<Scalar>(i < j ? before[c] : -before[c]);
      const Scalar push = rest > Scalar(0) ? stiffness * rest : Scalar(0);
      Vec<Scalar> f = scaled_sum(quantum, had, times(p.normal, push));
      if (friction > Scalar(0)) f = settle_friction(lower, p, numbers + std::int64_t{2} * PLIANT_TILE, stiffness, friction, f);
      lever = scaled_sum(i < j ? push : -push, p.arm, lever);
      const Quanta q = quanta_of(f, inverse, i < j);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += q[c] - before[c];
    }
    for (std::size_t c = 0; c < 3; ++c) change[static_cast<std::int64_t>(c)] = sum[c];
    change[3] = touching;
    if ((near & PLIANT_TOUCH_BIT) != 0) set_moment(touch_moment, i, mine, lever, inverse);
  }
}

void register_touch_settle(Registry& registry) { registry.add("touch_settle", touch_settle<float>, touch_settle<double>); }

}  // namespace pliant::ref
