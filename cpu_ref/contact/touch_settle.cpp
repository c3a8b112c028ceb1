// Twin of kernels/contact/touch_settle.cl.
#include "cpu_ref/contact/touch_tile.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace touch;

/// `f`: the normal force so far and the friction of the first part. Returns it with admissible friction, and moves the anchor
/// of a pair that pushes to where it slips.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> settle_friction(bool pushes, const Place<Scalar>& lower, const Pair<Scalar>& p,
                                                          Vec<Scalar>& anchor, Scalar stiffness, Scalar friction,
                                                          const Vec<Scalar>& f) {
  const Vec<Scalar> side = slip_of(lower, p, anchor);
  const Scalar across = dot(f, p.normal);
  const Vec<Scalar> pull = scaled_sum(-stiffness, side, scaled_sum(minus(across), p.normal, f));
  const Scalar length = std::sqrt(dot(pull, pull)), most = across > Scalar(0) ? friction * across : Scalar(0);
  const Scalar size = std::sqrt(dot(side, side)), hold = stiffness > Scalar(0) ? most / stiffness : Scalar(0);
  const Scalar kept = size > hold ? hold / size : Scalar(1);
  anchor = chosen(pushes && length > most, into_frame(lower, scaled_sum(-kept, side, p.apart)), anchor);
  return scaled_sum(length > most ? most / length : Scalar(1), pull, times(p.normal, across));
}

/// Sums over the pairs of the points of a tile.
template <class Scalar>
struct Settled {
  VecLanes<std::int32_t> force;
  Lanes<std::int32_t> touching;
  VecLanes<Scalar> lever{};
};

/// One slot of pairs.
template <bool Friction, class Scalar>
[[gnu::always_inline]] inline void settle_slot(std::int64_t first, const Places<Scalar>& mine, const Partners<Scalar>& partners,
                                               Scalar* numbers, std::int32_t* own, const Scalar* contact_params,
                                               Settled<Scalar>& sum) {
  const Scalar quantum = contact_params[0], inverse = contact_params[1], friction = contact_params[7];
  Scalar *offset = numbers + PLIANT_TILE, *anchors = offset + PLIANT_TILE;
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    const Scalar area = numbers[l];        // before any condition, like all that is read: gcc does not read ahead of one
    const std::int32_t mark = own[3 * PLIANT_TILE + l];
    const bool pushes = partners.number[l] > 0 && mark != 0;
    const bool is_lower = static_cast<std::int32_t>(first) + l < partners.number[l] - 1;
    const Place<Scalar> one = mine.at(l), other = partners.places.at(l);
    const Place<Scalar> lower = chosen(is_lower, one, other), upper = chosen(is_lower, other, one);
    const Pair<Scalar> p = pair_of(lower, upper);
    const Scalar rest = offset[l] - p.gap, w = lower.yielding + upper.yielding;
    const Scalar stiffness = w > Scalar(0) ? area / w : Scalar(0);
    const Quanta before{own[l], own[PLIANT_TILE + l], own[2 * PLIANT_TILE + l]}, had = turned_if(!is_lower, before);
    const Scalar push = rest > Scalar(0) ? stiffness * rest : Scalar(0);
    Vec<Scalar> f = scaled_sum(quantum, {Scalar(had[0]), Scalar(had[1]), Scalar(had[2])}, times(p.normal, push));
    if constexpr (Friction) {
      Vec<Scalar> anchor{anchors[l], anchors[PLIANT_TILE + l], anchors[2 * PLIANT_TILE + l]};
      f = settle_friction(pushes, lower, p, anchor, stiffness, friction, f);
      for (int c = 0; c < 3; ++c) anchors[c * PLIANT_TILE + l] = anchor[static_cast<std::size_t>(c)];
    }
    const Vec<Scalar> lever = lane(sum.lever, l);
    set_lane(sum.lever, l, chosen(pushes, scaled_sum(is_lower ? push : -push, p.arm, lever), lever));
    const Quanta q = quanta_of(f, inverse, is_lower);
    set_lane(sum.force, l, added_if(pushes, lane(sum.force, l), {q[0] - before[0], q[1] - before[1], q[2] - before[2]}));
    const Quanta whole = chosen(pushes, q, before);
    for (int c = 0; c < 3; ++c) own[c * PLIANT_TILE + l] = whole[static_cast<std::size_t>(c)];
    sum.touching[l] |= pushes ? PLIANT_TOUCH_BIT : 0;
  }
}

}  // namespace

template <class Scalar>
void touch_settle(Range range, const Scalar* touch_place, const std::int32_t* contact_list, const std::int32_t* contact_near,
                  std::int32_t* contact_change, const std::int32_t* touch_partner, Scalar* touch_pair,
                  std::int32_t* touch_force, std::int32_t* touch_moment, const Scalar* contact_params) {
  // Arrays of this function itself, and all inlined: gcc otherwise takes them for parts of the buffers.
  const auto settle = [&](auto with_friction) {
    Places<Scalar> mine;
    Partners<Scalar> partners;
    for (std::int64_t entry = range.begin; entry < range.end; entry += PLIANT_TILE) {
      const std::int64_t first = listed(contact_list, entry);
      const std::int32_t near = contact_near[first / PLIANT_TILE];
      if (near == 0) continue;
      std::int32_t* change = contact_change + tile_base(first, 4);
      Settled<Scalar> sum{};
      if ((near & ~PLIANT_TOUCH_BIT) != 0) std::copy_n(change, 3 * PLIANT_TILE, sum.force[0]);  // the forces of tools
      std::copy_n(change + 3 * PLIANT_TILE, PLIANT_TILE, sum.touching);
      if ((near & PLIANT_TOUCH_BIT) != 0) {
        load_tile(touch_place, first, mine);
        for (std::int64_t s = 0; s < PLIANT_TOUCH_SLOTS && partners.find(touch_partner, first, s); ++s) {
          std::int32_t* own = pair_force(touch_force, first, s);
          if (!partners.any(own + 3 * PLIANT_TILE)) continue;
          partners.load(touch_place);
          settle_slot<with_friction()>(first, mine, partners, pair_numbers(touch_pair, first, s), own, contact_params, sum);
        }
        set_moments(touch_moment, first, mine, sum.lever, contact_params[1]);
      }
      std::copy_n(sum.force[0], 3 * PLIANT_TILE, change);
      std::copy_n(sum.touching, PLIANT_TILE, change + 3 * PLIANT_TILE);
    }
  };
  contact_params[7] > Scalar(0) ? settle(std::true_type{}) : settle(std::false_type{});
}

void register_touch_settle(Registry& registry) { registry.add("touch_settle", touch_settle<float>, touch_settle<double>); }

}  // namespace pliant::ref
