// Twin of kernels/contact/touch_meet.cl, which describes the computation.
#pragma once
#include "cpu_ref/contact/touch_point.h"

namespace pliant::ref::touch {

template <class Scalar>
inline bool may_meet(const Scalar* a, const Scalar* b, Scalar margin, Scalar ahead) {
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

/// Upper bound of the distance between the point of box a and a partner in box b.
template <class Scalar>
inline Scalar farthest(const Scalar* a, const Scalar* b, Scalar margin, Scalar ahead) {
  const Scalar spacing = a[18] > b[18] ? a[18] : b[18];
  Scalar way = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Scalar rising = a[2 * c + 7] - b[2 * c + 6], falling = b[2 * c + 7] - a[2 * c + 6];
    way = way + (rising > falling ? rising : falling);
  }
  return std::fma(radius<Scalar> + Scalar(2), spacing, std::fma(ahead, way, margin));
}

/// Parameters of the search, the same for all points.
template <class Scalar>
struct Look {
  const Scalar *touch_place, *touch_surface, *touch_rest;
  const std::int32_t* contact_node;
  Scalar margin, ahead, ease;

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

  /// Returns whether two points are in one part and never touch; otherwise stores their undeformed depth.
  [[nodiscard]] bool one_part(std::int64_t lower, std::int64_t upper, Scalar large, Scalar& offset) const {
    offset = 0;
    if (body(lower) != body(upper)) return false;
    if (same_nodes(lower, upper)) return true;
    const Vec<Scalar> away = difference(three(touch_rest, tile_base(lower, 4), 0), three(touch_rest, tile_base(upper, 4), 0));
    const Vec<Scalar> na = rest_normal(lower), nb = rest_normal(upper);
    if (!(dot(away, away) < (Scalar(16) * large) * large)) return false;
    if (!(dot(na, nb) < Scalar(-0.5))) return true;
    const Scalar gap = dot(away, unit(difference(nb, na)));
    if (gap < Scalar(-0.2) * large) return true;
    offset = gap <= Scalar(0) ? gap : Scalar(0);
    return false;
  }

  /// Returns the weight of a pair (0: no pair) and its offset.
  [[nodiscard]] Scalar weigh(std::int64_t lower, std::int64_t upper, bool known, Scalar before, Scalar& offset) const {
    const Place<Scalar> a = place_of(touch_place, lower), b = place_of(touch_place, upper);
    const Scalar facing = std::fma(Scalar(-2), dot(a.normal, b.normal), Scalar(-1));
    if (!(facing > Scalar(0))) return 0;
    const Scalar one = spacing(lower), two = spacing(upper), large = one > two ? one : two;
    const Pair<Scalar> p = pair_of(a, b);
    const Vec<Scalar> side = scaled_sum(minus(dot(p.apart, p.normal)), p.normal, p.apart);
    const Scalar r = radius<Scalar> * large, part = dot(side, side) / (r * r);
    if (!(part < Scalar(1))) return 0;
    const Scalar closing = minus(dot(difference(a.moved, b.moved), p.normal));
    if (!(p.gap < std::fma(ahead, closing > Scalar(0) ? closing : Scalar(0), margin))) return 0;
    if (!(p.gap > (known ? Scalar(-2) * large : -large))) return 0;
    if (one_part(lower, upper, large, offset)) return 0;
    const Scalar start = known ? std::fma(ease, large, before) : p.gap;
    offset = start < offset ? start : offset;
    const Scalar rest = Scalar(1) - part;
    return (rest * rest) * facing;
  }
};

}  // namespace pliant::ref::touch
