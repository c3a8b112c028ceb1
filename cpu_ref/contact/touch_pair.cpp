// Twin of kernels/contact/touch_pair.cl.
#include <algorithm>

#include "cpu_ref/contact/touch_meet.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

using namespace touch;

constexpr std::int64_t kSlots = PLIANT_TOUCH_SLOTS, kFound = 64;

/// Collects the partners of a point.
template <class Scalar>
class Partners {
 public:
  /// Saves the previous partners and clears the slots.
  Partners(std::int64_t i, std::int32_t* touch_partner, Scalar* touch_pair, Scalar* touch_weight)
      : i_(i),
        partner_(touch_partner + tile_base(i, kSlots)),
        weight_(touch_weight + tile_base(i, kSlots + 1)),
        pair_(touch_pair) {
    for (; known_ < kSlots; ++known_) {
      const std::int64_t s = known_;
      old_[s] = partner_[s * PLIANT_TILE];
      if (old_[s] == 0) break;  // used slots come first
      for (std::int64_t c = 0; c < PLIANT_TOUCH_PAIR; ++c) kept_[s][c] = pair_numbers(pair_, i_, s)[c * PLIANT_TILE];
      partner_[s * PLIANT_TILE] = 0;
      weight_[s * PLIANT_TILE] = 0;
    }
    weight_[kSlots * PLIANT_TILE] = 0;
  }

  void try_one(const Look<Scalar>& look, std::int64_t j) {
    const auto name = static_cast<std::int32_t>(j + 1);
    std::int64_t before = 0;
    while (before < known_ && old_[before] != name) ++before;
    const bool known = before < known_ && kept_[before][0] > Scalar(0);
    Scalar offset = 0;
    const Scalar w = look.weigh(std::min(i_, j), std::max(i_, j), known, known ? kept_[before][1] : Scalar(0), offset);
    if (!(w > Scalar(0))) return;
    std::int64_t slot = filled_;
    if (filled_ == kSlots) {
      slot = 0;
      for (std::int64_t s = 1; s < kSlots; ++s) {
        if (weight_[s * PLIANT_TILE] < weight_[slot * PLIANT_TILE]) slot = s;
      }
      if (!(w > weight_[slot * PLIANT_TILE])) return;
    } else {
      ++filled_;
    }
    partner_[slot * PLIANT_TILE] = name;
    weight_[slot * PLIANT_TILE] = w;
    Scalar* numbers = pair_numbers(pair_, i_, slot);
    numbers[PLIANT_TILE] = offset;
    for (std::int64_t c = 2; c < PLIANT_TOUCH_PAIR; ++c) numbers[c * PLIANT_TILE] = known ? kept_[before][c] : Scalar(0);
  }

  /// Returns true if there are any.
  bool finish(const Scalar* contact_rest) {
    Scalar sum = 0;
    for (std::int64_t s = 0; s < filled_; ++s) {
      const std::int64_t j = partner_[s * PLIANT_TILE] - 1;
      sum = std::fma(contact_rest[tile_base(j, 4) + std::int64_t{3} * PLIANT_TILE], weight_[s * PLIANT_TILE], sum);
    }
    weight_[kSlots * PLIANT_TILE] = sum;
    return filled_ > 0;
  }

 private:
  std::int64_t i_, filled_ = 0, known_ = 0;
  std::int32_t* partner_;
  Scalar *weight_, *pair_;
  std::int32_t old_[kSlots];
  Scalar kept_[kSlots][PLIANT_TOUCH_PAIR];
};

/// The boxes of all tiles and groups.
template <class Scalar>
struct Boxes {
  const Scalar* box;
  const std::int32_t* node;
  std::int32_t count;
  Scalar margin, ahead;

  [[nodiscard]] const std::int32_t* at(std::int32_t k) const { return node + std::int64_t{PLIANT_TOUCH_TREE} * k; }
  [[nodiscard]] const Scalar* of(const std::int32_t* n) const { return box + std::int64_t{PLIANT_TOUCH_BOX} * n[0]; }
  [[nodiscard]] bool meets(const Scalar* own, const std::int32_t* n) const { return may_meet(own, of(n), margin, ahead); }

  /// Returns the number of tiles that a tile's points may meet, and lists the first kFound of them.
  std::int32_t near(const Scalar* own, std::int32_t* found) const {
    std::int32_t number = 0;
    for (std::int32_t k = 0; k < count;) {
      const std::int32_t* n = at(k);
      if (!meets(own, n)) {
        k = n[1];
        continue;
      }
      if (n[3] - n[2] == 1) {
        if (number < kFound) found[number] = k;
        ++number;
      }
      ++k;
    }
    return number;
  }
};

template <class Scalar>
void box_of_point(const Look<Scalar>& look, const Place<Scalar>& p, std::int64_t i, Scalar* box) {
  for (std::size_t c = 0; c < 3; ++c) {
    box[2 * c] = box[2 * c + 1] = p.x[c];
    box[2 * c + 6] = box[2 * c + 7] = p.moved[c];
    box[2 * c + 12] = box[2 * c + 13] = p.normal[c];
  }
  box[18] = look.spacing(i);
}

}  // namespace

template <class Scalar>
void touch_pair(Range range, const Scalar* touch_place, const Scalar* touch_box, const std::int32_t* touch_node,
                const Scalar* touch_surface, const Scalar* touch_rest, const Scalar* contact_rest,
                const std::int32_t* contact_node, std::int32_t* touch_partner, Scalar* touch_pair, Scalar* touch_weight,
                std::int32_t* contact_near, Scalar* contact_yield, const Scalar* contact_params, std::int32_t node_count) {
  const Scalar margin = contact_params[5], ahead = Scalar(2) * contact_params[6];
  const Look<Scalar> look{touch_place, touch_surface, touch_rest, contact_node, margin, ahead, contact_params[8]};
  const Boxes<Scalar> boxes{touch_box, touch_node, node_count, margin, ahead};
  for (std::int64_t tile = range.begin; tile < range.end; ++tile) {
    std::int32_t found[kFound];
    const std::int32_t count = boxes.near(touch_box + tile * PLIANT_TOUCH_BOX, found);
    const bool listed = count <= kFound;
    std::int32_t any = 0;
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      Partners<Scalar> partners(i, touch_partner, touch_pair, touch_weight);
      if (!(look.spacing(i) > Scalar(0))) continue;
      const Place<Scalar> p = place_of(touch_place, i);
      Scalar own[PLIANT_TOUCH_BOX];
      box_of_point(look, p, i, own);
      for (std::int32_t k = 0; k < (listed ? count : node_count);) {
        const std::int32_t* node = boxes.at(listed ? found[k] : k);
        if (!boxes.meets(own, node)) {
          k = listed ? k + 1 : node[1];
          continue;
        }
        ++k;
        if (node[3] - node[2] != 1) continue;
        const Scalar far = farthest(own, boxes.of(node), margin, ahead);
        for (std::int64_t j = std::int64_t{node[2]} * PLIANT_TILE; j < std::int64_t{node[3]} * PLIANT_TILE; ++j) {
          const Vec<Scalar> away = difference(place_of(touch_place, j).x, p.x);
          if (dot(away, away) < far * far && j != i && look.spacing(j) > Scalar(0)) partners.try_one(look, j);
        }
      }
      if (partners.finish(contact_rest)) any = PLIANT_TOUCH_BIT;
    }
    const std::int32_t before = contact_near[tile], near = (before & ~PLIANT_TOUCH_BIT) | any;
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE && near == 0 && before != 0; ++i)
      contact_yield[i] = 0;
    contact_near[tile] = near;
  }
}

void register_touch_pair(Registry& registry) { registry.add("touch_pair", touch_pair<float>, touch_pair<double>); }

}  // namespace pliant::ref
