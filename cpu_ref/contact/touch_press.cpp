// Twin of kernels/contact/touch_press.cl.
#include "cpu_ref/contact/touch_tile.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace touch;

/// The offset of a pair, lowered where its depth at the start of the step, at the gap `start`, exceeds the limit.
template <class Scalar>
[[gnu::always_inline]] inline Scalar limit_start(const Place<Scalar>& lower, const Place<Scalar>& upper, Scalar start,
                                                 Scalar ease, Scalar offset) {
  const Scalar sparse = lower.density < upper.density ? lower.density : upper.density;
  const Scalar most = start + (Scalar(4) * ease) / sparse;
  return offset > most ? most : offset;
}

/// Adds the friction of a pair towards its anchor, at most `most`.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> press_friction(const Place<Scalar>& lower, const Pair<Scalar>& p,
                                                         const Vec<Scalar>& anchor, Scalar stiffness, Scalar most,
                                                         const Vec<Scalar>& f) {
  const Vec<Scalar> side = slip_of(lower, p, anchor);
  const Scalar length = std::sqrt(dot(side, side));
  return scaled_sum(stiffness * length > most ? -(most / length) : -stiffness, side, f);
}

/// Sums over the pairs of the points of a tile.
template <class Scalar>
struct Pressed {
  VecLanes<std::int32_t> force;
  Lanes<std::int32_t> touching;
  VecLanes<Scalar> lever{};
  Lanes<Scalar> area{}, inside{};  ///< of the pairs that push; area times depth at the start of the step
};

/// One slot of pairs. `within`: distance of the points that may touch in the next step.
template <bool Friction, class Scalar>
[[gnu::always_inline]] inline void press_slot(std::int64_t first, const Places<Scalar>& mine, const Partners<Scalar>& partners,
                                              const Lanes<Scalar>& within, Scalar* numbers, std::int32_t* own,
                                              const Scalar* contact_params, Pressed<Scalar>& sum) {
  const Scalar inverse = contact_params[1], far = Scalar(0.48) * contact_params[5], friction = contact_params[7];
  const Scalar ease = contact_params[8];
  Scalar *offsets = numbers + PLIANT_TILE, *anchors = offsets + PLIANT_TILE, *stuck = anchors + 3 * PLIANT_TILE;
  std::int32_t* marks = own + 3 * PLIANT_TILE;
  for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
    // Everything is read before any condition: gcc does not read ahead of one.
    const Scalar area = numbers[l], offset = offsets[l], stays = stuck[l];
    const std::int32_t partner = partners.number[l], mark = marks[l];
    const Quanta had{own[l], own[PLIANT_TILE + l], own[2 * PLIANT_TILE + l]};
    const bool pairs = (partner > 0) & (area > Scalar(0)), is_lower = static_cast<std::int32_t>(first) + l < partner - 1;
    const Place<Scalar> one = mine.at(l), other = partners.places.at(l);
    const Place<Scalar> lower = chosen(is_lower, one, other), upper = chosen(is_lower, other, one);
    const Vec<Scalar> moved = difference(lower.moved, upper.moved);
    const Scalar front = front_of(lower, upper, moved), w = lower.yielding + upper.yielding;
    const bool ready = pairs & (front < within[l]), meets = pairs & (front < far) & (w > Scalar(0));
    const Pair<Scalar> p = pair_of(lower, upper);
    const Scalar limited = limit_start(lower, upper, dot(difference(p.apart, moved), p.normal), ease, offset);
    const Scalar kept = meets ? limited : offset, depth = kept - p.gap;
    const bool pushes = meets & (depth > Scalar(0)), leaves = pairs & !pushes;
    offsets[l] = kept;
    const Scalar stiffness = area / w, push = stiffness * depth, before = dot(moved, p.normal) - p.gap;
    Vec<Scalar> f = times(p.normal, push);
    if constexpr (Friction) {
      const Vec<Scalar> begins = into_frame(lower, difference(p.apart, moved));
      const Vec<Scalar> known{anchors[l], anchors[PLIANT_TILE + l], anchors[2 * PLIANT_TILE + l]};
      const bool fresh = pushes & (stays == Scalar(0));
      const Vec<Scalar> anchor = chosen(fresh, begins, known);
      f = press_friction(lower, p, anchor, stiffness, friction * push, f);
      for (int c = 0; c < 3; ++c) anchors[c * PLIANT_TILE + l] = anchor[static_cast<std::size_t>(c)];
      stuck[l] = leaves ? Scalar(0) : fresh ? Scalar(1) : stays;
    } else {
      stuck[l] = leaves ? Scalar(0) : stays;
    }
    const Vec<Scalar> lever = lane(sum.lever, l);
    set_lane(sum.lever, l, chosen(pushes, scaled_sum(is_lower ? push : -push, p.arm, lever), lever));
    const Quanta q = quanta_of(f, inverse, is_lower), force = chosen(pushes, q, had);
    for (int c = 0; c < 3; ++c) own[c * PLIANT_TILE + l] = force[static_cast<std::size_t>(c)];
    marks[l] = pushes ? 1 : partner > 0 ? 0 : mark;
    set_lane(sum.force, l, added_if(pushes, lane(sum.force, l), q));
    sum.touching[l] |= (pushes ? PLIANT_TOUCH_BIT : 0) | (ready ? PLIANT_READY_BIT : 0);
    const Scalar pressed = sum.area[l], inside = sum.inside[l];
    sum.area[l] = pushes ? pressed + area : pressed;
    sum.inside[l] = pushes ? std::fma(area, before, inside) : inside;
  }
}

}  // namespace

template <class Scalar>
void touch_press(Range range, const Scalar* touch_place, const std::int32_t* contact_list, const std::int32_t* contact_near,
                 const Scalar* contact_yield, const std::int32_t* contact_force, std::int32_t* contact_change,
                 const std::int32_t* touch_partner, Scalar* touch_pair, std::int32_t* touch_force, std::int32_t* touch_moment,
                 Scalar* touch_depth, const Scalar* contact_params) {
  // Arrays of this function itself, and all inlined: gcc otherwise takes them for parts of the buffers.
  const auto press = [&](auto with_friction) {
    Places<Scalar> mine;
    Partners<Scalar> partners;
    Lanes<Scalar> within;
    for (std::int64_t entry = range.begin; entry < range.end; entry += PLIANT_TILE) {
      const std::int64_t first = listed(contact_list, entry);
      const std::int32_t near = contact_near[first / PLIANT_TILE];
      if (near == 0) continue;
      Pressed<Scalar> sum{};
      if ((near & ~PLIANT_TOUCH_BIT) != 0) {  // the forces of tools
        const std::int32_t* force = contact_force + tile_base(first, 4);
        std::copy_n(force, 3 * PLIANT_TILE, sum.force[0]);
        std::copy_n(force + 3 * PLIANT_TILE, PLIANT_TILE, sum.touching);
      }
      if ((near & PLIANT_TOUCH_BIT) != 0) {
        load_tile(touch_place, first, mine);
        for (int l = 0; l < PLIANT_TILE; ++l)
          within[l] = (Scalar(2) * contact::ready_share(contact_yield[first + l])) * contact_params[5];
        for (std::int64_t s = 0; s < PLIANT_TOUCH_SLOTS && partners.find(touch_partner, first, s); ++s) {
          partners.load(touch_place);
          press_slot<with_friction()>(first, mine, partners, within, pair_numbers(touch_pair, first, s),
                                      pair_force(touch_force, first, s), contact_params, sum);
        }
        set_moments(touch_moment, first, mine, sum.lever, contact_params[1]);
      }
      for (int l = 0; l < PLIANT_TILE; ++l) {
        const Scalar mean = sum.area[l] > Scalar(0) ? sum.inside[l] / sum.area[l] : Scalar(0), deepest = touch_depth[first + l];
        touch_depth[first + l] = mean > deepest ? mean : deepest;
      }
      std::int32_t* change = contact_change + tile_base(first, 4);
      std::copy_n(sum.force[0], 3 * PLIANT_TILE, change);
      std::copy_n(sum.touching, PLIANT_TILE, change + 3 * PLIANT_TILE);
    }
  };
  contact_params[7] > Scalar(0) ? press(std::true_type{}) : press(std::false_type{});
}

void register_touch_press(Registry& registry) { registry.add("touch_press", touch_press<float>, touch_press<double>); }

}  // namespace pliant::ref
