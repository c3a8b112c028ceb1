// Twin of kernels/touch_pair.cl.
#include "registry.h"
#include "touch_point.h"

namespace pliant::ref {
namespace {

using namespace touch;

constexpr std::int64_t kSlots = PLIANT_TOUCH_SLOTS, kFound = 64;

template <class Scalar>
bool may_meet(const Scalar* a, const Scalar* b, Scalar margin, Scalar ahead) {
  const Scalar spacing = a[18] > b[18] ? a[18] : b[18], reach = std::fma(radius<Scalar>, spacing, margin);
  Scalar facing = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Scalar above = b[2 * c] - a[2 * c + 1], rising = a[2 * c + 7] - b[2 * c + 6];
    const Scalar below = a[2 * c] - b[2 * c + 1], falling = b[2 * c + 7] - a[2 * c + 6];
    if (above - ahead * (rising > Scalar(0) ? rising : Scalar(0)) > reach) return false;
    if (below - ahead * (falling > Scalar(0) ? falling : Scalar(0)) > reach) return false;
    const Scalar ll = a[2 * c + 12] * b[2 * c + 12], lh = a[2 * c + 12] * b[2 * c + 13];
    const Scalar hl = a[2 * c + 13] * b[2 * c + 12], hh = a[2 * c + 13] * b[2 * c + 13];
    const Scalar l = ll < lh ? ll : lh, m = hl < hh ? hl : hh;
    facing = facing + (l < m ? l : m);
  }
  return facing < Scalar(-0.5);
}

/// No point of box b is a partner of the point of box a that is farther from it than this.
template <class Scalar>
Scalar farthest(const Scalar* a, const Scalar* b, Scalar margin, Scalar ahead) {
  const Scalar spacing = a[18] > b[18] ? a[18] : b[18];
  Scalar way = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Scalar rising = a[2 * c + 7] - b[2 * c + 6], falling = b[2 * c + 7] - a[2 * c + 6];
    way = way + (rising > falling ? rising : falling);
  }
  return std::fma(radius<Scalar> + Scalar(2), spacing, std::fma(ahead, way, margin));
}

/// What the look knows, the same for all points.
template <class Scalar>
struct Look {
  const Scalar *touch_place, *touch_surface, *touch_rest;
  const std::int32_t* contact_node;
  Scalar margin, ahead;

  [[nodiscard]] Scalar spacing(std::int64_t i) const {
    return touch_surface[tile_base(i, PLIANT_TOUCH_SURFACE) + std::int64_t{22} * PLIANT_TILE];
  }
  [[nodiscard]] Vec<Scalar> rest_normal(std::int64_t i) const {
    const std::int64_t base = tile_base(i, PLIANT_TOUCH_SURFACE);
    return cross(three(touch_surface, base, 16), three(touch_surface, base, 19));
  }
  [[nodiscard]] bool same_nodes(std::int64_t i, std::int64_t j) const {
    std::int32_t other = 0;
    for (std::int64_t a = 0; a < 8; ++a)
      other |= contact_node[tile_base(i, 8) + a * PLIANT_TILE] ^ contact_node[tile_base(j, 8) + a * PLIANT_TILE];
    return other == 0;
  }
  [[nodiscard]] std::int32_t body(std::int64_t i) const {
    return static_cast<std::int32_t>(touch_rest[tile_base(i, 4) + std::int64_t{3} * PLIANT_TILE]);
  }

  /// The weight of a pair, 0: none; and its depth at rest.
  [[nodiscard]] Scalar weigh(std::int64_t lower, std::int64_t upper, bool known, Scalar& offset) const {
    const Place<Scalar> a = place_of(touch_place, lower), b = place_of(touch_place, upper);
    const Scalar facing = std::fma(Scalar(-2), dot(a.normal, b.normal), Scalar(-1));
    if (!(facing > Scalar(0))) return 0;
    const Scalar one = spacing(lower), two = spacing(upper), large = one > two ? one : two;
    const Pair<Scalar> p = pair_of(a, b);
    const Vec<Scalar> side = scaled_sum(-p.gap, p.normal, p.apart);
    const Scalar r = radius<Scalar> * large, part = dot(side, side) / (r * r);
    if (!(part < Scalar(1))) return 0;
    const Scalar closing = -dot(difference(a.moved, b.moved), p.normal);
    if (!(p.gap < std::fma(ahead, closing > Scalar(0) ? closing : Scalar(0), margin))) return 0;
    if (!(p.gap > (known ? Scalar(-2) * large : -large))) return 0;
    offset = 0;
    if (body(lower) == body(upper)) {
      if (same_nodes(lower, upper)) return 0;
      const Vec<Scalar> away = difference(three(touch_rest, tile_base(lower, 4), 0), three(touch_rest, tile_base(upper, 4), 0));
      const Vec<Scalar> na = rest_normal(lower), nb = rest_normal(upper);
      if (dot(away, away) < (Scalar(16) * large) * large) {
        if (!(dot(na, nb) < Scalar(-0.5))) return 0;
        const Scalar gap = dot(away, unit(difference(nb, na)));
        if (gap < Scalar(-0.2) * large) return 0;
        offset = gap < Scalar(0) ? gap : Scalar(0);
      }
    }
    const Scalar rest = Scalar(1) - part;
    return (rest * rest) * facing;
  }
};

}  // namespace

template <class Scalar>
void touch_pair(Range range, const Scalar* touch_place, const Scalar* touch_box, const std::int32_t* touch_node,
                const Scalar* touch_surface, const Scalar* touch_rest, const Scalar* contact_rest,
                const std::int32_t* contact_node, std::int32_t* touch_partner, Scalar* touch_pair, Scalar* touch_weight,
                std::int32_t* contact_near, const Scalar* contact_params, std::int32_t node_count) {
  const Scalar margin = contact_params[5], ahead = Scalar(2) * contact_params[6];
  const Look<Scalar> look{touch_place, touch_surface, touch_rest, contact_node, margin, ahead};
  for (std::int64_t tile = range.begin; tile < range.end; ++tile) {
    const Scalar* own_box = touch_box + tile * PLIANT_TOUCH_BOX;
    std::int32_t found[kFound];
    std::int32_t count = 0;
    for (std::int32_t k = 0; k < node_count;) {
      const std::int32_t* node = touch_node + std::int64_t{PLIANT_TOUCH_TREE} * k;
      if (!may_meet(own_box, touch_box + std::int64_t{PLIANT_TOUCH_BOX} * node[0], margin, ahead)) {
        k = node[1];
        continue;
      }
      if (node[3] - node[2] == 1) {
        if (count < kFound) found[count] = k;
        ++count;
      }
      ++k;
    }
    std::int32_t any = 0;
    for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
      std::int32_t old[kSlots];
      Scalar kept[kSlots][4];
      std::int32_t* partner = touch_partner + tile_base(i, kSlots);
      Scalar* weight = touch_weight + tile_base(i, kSlots + 1);
      for (std::int64_t s = 0; s < kSlots; ++s) {
        old[s] = partner[s * PLIANT_TILE];
        for (std::int64_t c = 0; c < 4; ++c) kept[s][c] = pair_numbers(touch_pair, i, s)[(2 + c) * PLIANT_TILE];
        partner[s * PLIANT_TILE] = 0;
        weight[s * PLIANT_TILE] = 0;
      }
      weight[kSlots * PLIANT_TILE] = 0;
      if (!(look.spacing(i) > Scalar(0))) continue;
      const Place<Scalar> p = place_of(touch_place, i);
      Scalar point_box[PLIANT_TOUCH_BOX];
      for (std::size_t c = 0; c < 3; ++c) {
        point_box[2 * c] = point_box[2 * c + 1] = p.x[c];
        point_box[2 * c + 6] = point_box[2 * c + 7] = p.moved[c];
        point_box[2 * c + 12] = point_box[2 * c + 13] = p.normal[c];
      }
      point_box[18] = look.spacing(i);
      const bool listed = count <= kFound;
      std::int64_t filled = 0;
      for (std::int32_t k = 0; k < (listed ? count : node_count);) {
        const std::int32_t* node = touch_node + std::int64_t{PLIANT_TOUCH_TREE} * (listed ? found[k] : k);
        if (!may_meet(point_box, touch_box + std::int64_t{PLIANT_TOUCH_BOX} * node[0], margin, ahead)) {
          k = listed ? k + 1 : node[1];
          continue;
        }
        ++k;
        if (node[3] - node[2] != 1) continue;
        const Scalar far = farthest(point_box, touch_box + std::int64_t{PLIANT_TOUCH_BOX} * node[0], margin, ahead);
        for (std::int64_t j = std::int64_t{node[2]} * PLIANT_TILE; j < std::int64_t{node[3]} * PLIANT_TILE; ++j) {
          const Vec<Scalar> away = difference(three(touch_place, tile_base(j, PLIANT_TOUCH_PLACE), 0), p.x);
          if (!(dot(away, away) < far * far)) continue;
          if (j == i || !(look.spacing(j) > Scalar(0))) continue;
          const auto name = static_cast<std::int32_t>(j + 1);
          std::int64_t before = 0;
          while (before < kSlots && old[before] != name) ++before;
          Scalar offset = 0;
          const Scalar w = look.weigh(i < j ? i : j, i < j ? j : i, before < kSlots, offset);
          if (!(w > Scalar(0))) continue;
          std::int64_t slot = filled;
          if (filled == kSlots) {  // the weakest gives way
            slot = 0;
            for (std::int64_t s = 1; s < kSlots; ++s) {
              if (weight[s * PLIANT_TILE] < weight[slot * PLIANT_TILE]) slot = s;
            }
            if (!(w > weight[slot * PLIANT_TILE])) continue;
          } else {
            ++filled;
          }
          partner[slot * PLIANT_TILE] = name;
          weight[slot * PLIANT_TILE] = w;
          Scalar* numbers = pair_numbers(touch_pair, i, slot);
          numbers[PLIANT_TILE] = offset;
          for (std::int64_t c = 0; c < 4; ++c) numbers[(2 + c) * PLIANT_TILE] = before < kSlots ? kept[before][c] : Scalar(0);
        }
      }
      Scalar sum = 0;
      for (std::int64_t s = 0; s < filled; ++s) {
        const std::int64_t j = partner[s * PLIANT_TILE] - 1;
        sum = std::fma(contact_rest[tile_base(j, 4) + std::int64_t{3} * PLIANT_TILE], weight[s * PLIANT_TILE], sum);
      }
      weight[kSlots * PLIANT_TILE] = sum;
      if (filled > 0) any = PLIANT_TOUCH_BIT;
    }
    contact_near[tile] = (contact_near[tile] & ~PLIANT_TOUCH_BIT) | any;
  }
}

void register_touch_pair(Registry& registry) { registry.add("touch_pair", touch_pair<float>, touch_pair<double>); }

}  // namespace pliant::ref
