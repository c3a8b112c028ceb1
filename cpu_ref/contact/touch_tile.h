// A tile of points, sorted by component, so that the compiler computes 16 pairs together: loops over lanes without branches.
#pragma once
#include <algorithm>

#include "cpu_ref/contact/touch_point.h"
#include "cpu_ref/texels.h"

namespace pliant::ref::touch {

template <class T>
using Lanes = T[PLIANT_TILE];
template <class T>
using VecLanes = T[3][PLIANT_TILE];

template <class T>
[[gnu::always_inline]] inline std::array<T, 3> lane(const VecLanes<T>& v, int l) {
  return {v[0][l], v[1][l], v[2][l]};
}
template <class T>
[[gnu::always_inline]] inline void set_lane(VecLanes<T>& v, int l, const std::array<T, 3>& value) {
  v[0][l] = value[0], v[1][l] = value[1], v[2][l] = value[2];
}

/// `a` where `first` is true, `b` elsewhere.
template <class T>
[[gnu::always_inline]] inline std::array<T, 3> chosen(bool first, const std::array<T, 3>& a, const std::array<T, 3>& b) {
  return {first ? a[0] : b[0], first ? a[1] : b[1], first ? a[2] : b[2]};
}
template <class Scalar>
[[gnu::always_inline]] inline Place<Scalar> chosen(bool first, const Place<Scalar>& a, const Place<Scalar>& b) {
  return {chosen(first, a.x, b.x),           chosen(first, a.moved, b.moved),
          chosen(first, a.normal, b.normal), chosen(first, a.tangent, b.tangent),
          chosen(first, a.tilt, b.tilt),     first ? a.yielding : b.yielding,
          first ? a.density : b.density,     chosen(first, a.dual, b.dual)};
}

/// -q where `turned`.
[[gnu::always_inline]] inline Quanta turned_if(bool turned, const Quanta& q) {
  return {turned ? -q[0] : q[0], turned ? -q[1] : q[1], turned ? -q[2] : q[2]};
}
/// sum + q where `counts`.
[[gnu::always_inline]] inline Quanta added_if(bool counts, const Quanta& sum, const Quanta& q) {
  return {sum[0] + (counts ? q[0] : 0), sum[1] + (counts ? q[1] : 0), sum[2] + (counts ? q[2] : 0)};
}

/// States of 16 points: rows of touch_place, five texels each, which become columns.
template <class Scalar>
struct Places {
  static constexpr int texels = PLIANT_TOUCH_PLACE / 4;
  SortedTexels<Scalar> number[texels];

  /// The points point(0) .. point(15).
  template <class Point>
  void load(const Scalar* touch_place, const Point& point) {
    Scalar rows[texels][PLIANT_TILE][4];
    for (int l = 0; l < PLIANT_TILE; ++l) {
      const Scalar* row = touch_place + std::int64_t{PLIANT_TOUCH_PLACE} * point(l);
      for (int t = 0; t < texels; ++t) std::copy_n(row + 4 * t, 4, rows[t][l]);
    }
    for (int t = 0; t < texels; ++t) load_texels(rows[t][0], number[t]);
  }
  [[nodiscard, gnu::always_inline]] inline Place<Scalar> at(int l) const {
    const auto& n = number;
    return {{n[0][0][l], n[0][1][l], n[0][2][l]},
            {n[1][0][l], n[1][1][l], n[1][2][l]},
            {n[2][0][l], n[2][1][l], n[2][2][l]},
            {n[3][0][l], n[3][1][l], n[3][2][l]},
            {n[4][0][l], n[4][1][l], n[4][2][l]},
            n[0][3][l],
            n[4][3][l],
            {n[1][3][l], n[2][3][l], n[3][3][l]}};
  }
  [[gnu::always_inline]] inline void set(int l, const Place<Scalar>& p) {
    auto& n = number;
    for (std::size_t c = 0; c < 3; ++c) {
      n[0][c][l] = p.x[c], n[1][c][l] = p.moved[c], n[2][c][l] = p.normal[c];
      n[3][c][l] = p.tangent[c], n[4][c][l] = p.tilt[c];
    }
    n[0][3][l] = p.yielding, n[4][3][l] = p.density;
    n[1][3][l] = p.dual[0], n[2][3][l] = p.dual[1], n[3][3][l] = p.dual[2];
  }
};
template <class Scalar>
inline void load_tile(const Scalar* touch_place, std::int64_t first, Places<Scalar>& places) {
  places.load(touch_place, [first](int l) { return first + l; });
}
template <class Scalar>
inline void store_tile(Scalar* touch_place, std::int64_t first, const Places<Scalar>& places) {
  Scalar rows[Places<Scalar>::texels][PLIANT_TILE][4];
  for (int t = 0; t < Places<Scalar>::texels; ++t) store_texels(places.number[t], rows[t][0]);
  for (int l = 0; l < PLIANT_TILE; ++l) {
    for (int t = 0; t < Places<Scalar>::texels; ++t)
      std::copy_n(rows[t][l], 4, touch_place + PLIANT_TOUCH_PLACE * (first + l) + 4 * t);
  }
}

/// One slot of the pairs of a tile.
template <class Scalar>
struct Partners {
  Lanes<std::int32_t> number;  ///< of the partner, from 1 on; 0: none
  Places<Scalar> places;       ///< where there is one

  /// Returns false if no point has a partner in this slot: then none has one in the next.
  bool find(const std::int32_t* touch_partner, std::int64_t first, std::int64_t slot) {
    const std::int32_t* of = touch_partner + tile_base(first, PLIANT_TOUCH_SLOTS) + slot * PLIANT_TILE;
    std::copy_n(of, PLIANT_TILE, number);
    return std::any_of(number, number + PLIANT_TILE, [](std::int32_t n) { return n > 0; });
  }
  /// Returns whether `mark` is set for a pair.
  [[nodiscard]] bool any(const std::int32_t* mark) const {
    bool found = false;
    for (int l = 0; l < PLIANT_TILE; ++l) found |= number[l] > 0 && mark[l] != 0;
    return found;
  }
  void load(const Scalar* touch_place) {
    places.load(touch_place, [this](int l) { return std::max(number[l] - 1, 0); });
  }
};

/// Effect of the pushes on the tangents of 16 points (set_moment).
template <class Scalar>
void set_moments(std::int32_t* touch_moment, std::int64_t first, const Places<Scalar>& own, const VecLanes<Scalar>& lever,
                 Scalar inverse) {
  VecLanes<std::int32_t> one, two;
  for (int l = 0; l < PLIANT_TILE; ++l) {
    const Place<Scalar> p = own.at(l);
    const std::array<Scalar, 2> turn = dual_of(p, lane(lever, l));
    set_lane(one, l, contact::quanta(times(p.normal, turn[0] * p.density), inverse));
    set_lane(two, l, contact::quanta(times(p.normal, turn[1] * p.density), inverse));
  }
  for (int l = 0; l < PLIANT_TILE; ++l) {
    std::int32_t* moment = touch_moment + (first + l) * PLIANT_TOUCH_MOMENT;
    for (int c = 0; c < 3; ++c) {
      moment[c] = one[c][l];
      moment[4 + c] = two[c][l];
    }
    moment[3] = moment[7] = 0;
  }
}

}  // namespace pliant::ref::touch
