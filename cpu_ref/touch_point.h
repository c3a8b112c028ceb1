// Twin of kernels/touch_point.cl, which says what is computed.
#pragma once
#include "contact_sum.h"

namespace pliant::ref::touch {

using contact::difference;
using contact::dot;
using contact::Quanta;
using contact::scaled_sum;
using contact::times;
using contact::Vec;

/// Of a pair, in spacings of the points.
template <class Scalar>
inline constexpr Scalar radius = Scalar(1.2);

/// Three planes of a tiled array from `plane` on.
template <class T>
inline auto three(const T* numbers, std::int64_t base, std::int64_t plane) {
  const T* at = numbers + base + plane * PLIANT_TILE;
  return std::array<T, 3>{at[0], at[PLIANT_TILE], at[std::int64_t{2} * PLIANT_TILE]};
}
template <class T, class Three>
inline void set_three(T* numbers, std::int64_t base, std::int64_t plane, const Three& v) {
  for (std::size_t c = 0; c < 3; ++c) numbers[base + (plane + static_cast<std::int64_t>(c)) * PLIANT_TILE] = v[c];
}

template <class Scalar>
inline Vec<Scalar> cross(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return {std::fma(a[1], b[2], -(a[2] * b[1])), std::fma(a[2], b[0], -(a[0] * b[2])), std::fma(a[0], b[1], -(a[1] * b[0]))};
}
template <class Scalar>
inline Vec<Scalar> unit(const Vec<Scalar>& v) {
  return contact::normalised(v, std::sqrt(dot(v, v)));
}

/// Where a point is: planes of touch_place.
template <class Scalar>
struct Place {
  Vec<Scalar> x{}, moved{}, normal{}, tangent{};
  Scalar yielding = 0;
};

template <class Scalar>
inline Place<Scalar> place_of(const Scalar* touch_place, std::int64_t i) {
  const Scalar* p = touch_place + i * PLIANT_TOUCH_PLACE;
  return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}, {p[8], p[9], p[10]}, {p[12], p[13], p[14]}, p[3]};
}

/// The deformed normal and first tangent of a point.
template <class Scalar>
inline std::array<Vec<Scalar>, 2> frame_of(const contact::Points<Scalar>& points, const Scalar* touch_surface, std::int64_t i) {
  const std::int64_t own = tile_base(i, PLIANT_TOUCH_SURFACE), base = tile_base(i, 8);
  Vec<Scalar> first = three(touch_surface, own, 16), second = three(touch_surface, own, 19);
  for (std::int64_t a = 0; a < 8; ++a) {
    const Scalar* u = points.node_u + std::int64_t{4} * points.node[base + a * PLIANT_TILE];
    const Vec<Scalar> moved{u[0], u[1], u[2]};
    first = scaled_sum(touch_surface[own + a * PLIANT_TILE], moved, first);
    second = scaled_sum(touch_surface[own + (8 + a) * PLIANT_TILE], moved, second);
  }
  return {unit(cross(first, second)), unit(first)};
}

/// Number `row` of a point's place: 0 place, 1 increment, 2 normal, 3 tangent.
template <class Scalar>
inline void set_row(Scalar* touch_place, std::int64_t i, std::int64_t row, const Vec<Scalar>& v) {
  for (std::size_t c = 0; c < 3; ++c) touch_place[i * PLIANT_TOUCH_PLACE + 4 * row + static_cast<std::int64_t>(c)] = v[c];
  if (row > 0) touch_place[i * PLIANT_TOUCH_PLACE + 4 * row + 3] = 0;
}

/// Two points that may push each other; `lower` has the lower index.
template <class Scalar>
struct Pair {
  Vec<Scalar> apart{}, normal{};  ///< lower minus upper; what pushes the lower one
  Scalar gap = 0;
};

template <class Scalar>
inline bool may_push(const Place<Scalar>& lower, const Place<Scalar>& upper) {
  return dot(difference(lower.x, upper.x), difference(upper.normal, lower.normal)) < Scalar(0);
}

template <class Scalar>
inline Pair<Scalar> pair_of(const Place<Scalar>& lower, const Place<Scalar>& upper) {
  Pair<Scalar> p;
  p.apart = difference(lower.x, upper.x);
  p.normal = unit(difference(upper.normal, lower.normal));
  p.gap = dot(p.apart, p.normal);
  return p;
}

/// The frame that moves with the lower point: its rows, and back.
template <class Scalar>
inline Vec<Scalar> into_frame(const Place<Scalar>& lower, const Vec<Scalar>& v) {
  return {dot(lower.tangent, v), dot(cross(lower.normal, lower.tangent), v), dot(lower.normal, v)};
}
template <class Scalar>
inline Vec<Scalar> out_of_frame(const Place<Scalar>& lower, const Vec<Scalar>& v) {
  return scaled_sum(v[0], lower.tangent, scaled_sum(v[1], cross(lower.normal, lower.tangent), times(lower.normal, v[2])));
}

/// Slip of a pair against where it stuck, along the surface.
template <class Scalar>
inline Vec<Scalar> slip_of(const Place<Scalar>& lower, const Pair<Scalar>& p, const Vec<Scalar>& stuck) {
  const Vec<Scalar> slip = difference(p.apart, out_of_frame(lower, stuck));
  return scaled_sum(-dot(slip, p.normal), p.normal, slip);
}

/// Numbers of a partner: plane k of touch_pair.
template <class T>
inline T* pair_numbers(T* touch_pair, std::int64_t i, std::int64_t slot) {
  return touch_pair + tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_PAIR) + slot * PLIANT_TOUCH_PAIR * PLIANT_TILE;
}
template <class T>
inline T* pair_force(T* touch_force, std::int64_t i, std::int64_t slot) {
  return touch_force + tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + slot * PLIANT_TOUCH_FORCE * PLIANT_TILE;
}

}  // namespace pliant::ref::touch
