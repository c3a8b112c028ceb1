// Twin of kernels/contact/touch_point.cl, which describes the computation.
#pragma once
#include <algorithm>

#include "cpu_ref/contact/contact_sum.h"

namespace pliant::ref::touch {

using contact::difference;
using contact::dot;
using contact::Quanta;
using contact::scaled_sum;
using contact::times;
using contact::Vec;

/// Search radius of a pair, in spacings of the points.
template <class Scalar>
inline constexpr Scalar radius = Scalar(1.2);

/// Three consecutive planes of a tiled array, starting at `plane`.
template <class T>
[[gnu::always_inline]] inline auto three(const T* numbers, std::int64_t base, std::int64_t plane) {
  const T* at = numbers + base + plane * PLIANT_TILE;
  return std::array<T, 3>{at[0], at[PLIANT_TILE], at[std::int64_t{2} * PLIANT_TILE]};
}
template <class T, class Three>
inline void set_three(T* numbers, std::int64_t base, std::int64_t plane, const Three& v) {
  for (std::size_t c = 0; c < 3; ++c) numbers[base + (plane + static_cast<std::int64_t>(c)) * PLIANT_TILE] = v[c];
}

template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> cross(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return {std::fma(a[1], b[2], -(a[2] * b[1])), std::fma(a[2], b[0], -(a[0] * b[2])), std::fma(a[0], b[1], -(a[1] * b[0]))};
}
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> unit(const Vec<Scalar>& v) {
  return contact::normalised(v, std::sqrt(dot(v, v)));
}

/// State of a point: a row of touch_place.
template <class Scalar>
struct Place {
  Vec<Scalar> x{}, moved{}, normal{}, tangent{}, tilt{};
  Scalar yielding = 0, density = 0;  ///< compliance W, and density of points: 1 / spacing [1/m]
  std::array<Scalar, 3> dual{};      ///< of the tangents: 1 / |F t1|, skew, 1 / height of F t2 over F t1
};

template <class Scalar>
inline Place<Scalar> place_of(const Scalar* touch_place, std::int64_t i) {
  const Scalar* p = touch_place + i * PLIANT_TOUCH_PLACE;
  return {
      {p[0], p[1], p[2]},  {p[4], p[5], p[6]}, {p[8], p[9], p[10]}, {p[12], p[13], p[14]}, {p[16], p[17], p[18]}, p[3], p[19],
      {p[7], p[11], p[15]}};
}

/// Sums over the nodes of a point, weighted by the gradients along both tangents: of displacements and of increments.
template <class Scalar>
struct AlongTangents {
  Vec<Scalar> first_u{}, second_u{}, first_w{}, second_w{};
};
template <class Scalar>
inline AlongTangents<Scalar> along_tangents(const contact::Points<Scalar>& points, const Scalar* touch_surface,
                                            std::int64_t i) {
  const std::int64_t own = tile_base(i, PLIANT_TOUCH_SURFACE), base = tile_base(i, 8);
  AlongTangents<Scalar> out;
  for (std::int64_t a = 0; a < 8; ++a) {
    const std::int64_t texel = std::int64_t{4} * points.node[base + a * PLIANT_TILE];
    const Scalar *u = points.node_u + texel, *w = points.node_w + texel;
    const Scalar first = touch_surface[own + a * PLIANT_TILE], second = touch_surface[own + (8 + a) * PLIANT_TILE];
    out.first_u = scaled_sum(first, Vec<Scalar>{u[0], u[1], u[2]}, out.first_u);
    out.second_u = scaled_sum(second, Vec<Scalar>{u[0], u[1], u[2]}, out.second_u);
    out.first_w = scaled_sum(first, Vec<Scalar>{w[0], w[1], w[2]}, out.first_w);
    out.second_w = scaled_sum(second, Vec<Scalar>{w[0], w[1], w[2]}, out.second_w);
  }
  return out;
}

/// Components of v along the dual vectors of a point's tangents [1/m of v].
template <class Scalar>
[[gnu::always_inline]] inline std::array<Scalar, 2> dual_of(const Place<Scalar>& p, const Vec<Scalar>& v) {
  const Scalar second = dot(v, cross(p.normal, p.tangent));
  return {std::fma(-p.dual[1], second, dot(v, p.tangent)) * p.dual[0], second * p.dual[2]};
}

/// The frame of a point at the start of the step, and the change of its normal in the step. `surface`: its numbers in
/// touch_surface.
template <class Scalar>
[[gnu::always_inline]] inline void set_frame(const AlongTangents<Scalar>& along, const Scalar* surface, Place<Scalar>& p) {
  const Vec<Scalar> first = difference(contact::sum_of(three(surface, 0, 16), along.first_u), along.first_w);
  const Vec<Scalar> second = difference(contact::sum_of(three(surface, 0, 19), along.second_u), along.second_w);
  p.normal = unit(cross(first, second));
  const Scalar length = std::sqrt(dot(first, first));
  p.tangent = contact::normalised(first, length);
  const Scalar height = dot(second, cross(p.normal, p.tangent));
  constexpr auto crushed = Scalar(0.5), slope = Scalar(4);
  p.dual = {length > crushed ? Scalar(1) / length : slope * length, Scalar(0),
            height > crushed ? Scalar(1) / height : slope * height};
  p.dual[1] = dot(second, p.tangent) * p.dual[2];
  const Scalar spacing = surface[22 * PLIANT_TILE];
  p.density = spacing > Scalar(0) ? Scalar(1) / spacing : Scalar(0);
}

/// The normal changes by -(n . F' t_k) a^k, with the dual vectors a^k of the tangents.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> tilt_of(const AlongTangents<Scalar>& along, const Place<Scalar>& p) {
  const Scalar one = dot(p.normal, along.first_w) * p.dual[0], two = dot(p.normal, along.second_w);
  const Scalar across = std::fma(two, p.dual[2], -(one * p.dual[1]));
  return difference(Vec<Scalar>{}, scaled_sum(one, p.tangent, times(cross(p.normal, p.tangent), across)));
}

template <class Scalar>
inline void write_place(Scalar* touch_place, std::int64_t i, const Place<Scalar>& p) {
  Scalar* at = touch_place + i * PLIANT_TOUCH_PLACE;
  const Vec<Scalar>* rows[] = {&p.x, &p.moved, &p.normal, &p.tangent, &p.tilt};
  const Scalar last[] = {p.yielding, p.dual[0], p.dual[1], p.dual[2], p.density};
  for (std::size_t r = 0; r < 5; ++r) {
    for (std::size_t c = 0; c < 3; ++c) at[4 * r + c] = (*rows[r])[c];
    at[4 * r + 3] = last[r];
  }
}

/// Two points that may push each other; `lower` has the lower index.
template <class Scalar>
struct Pair {
  Vec<Scalar> apart{}, normal{};  ///< lower minus upper position; direction of the push on the lower point
  Vec<Scalar> arm{};  ///< derivative of the gap with respect to the upper normal, and minus that for the lower normal [m]
  Scalar gap = 0;
};

template <class Scalar>
[[gnu::always_inline]] inline Scalar front_of(const Place<Scalar>& lower, const Place<Scalar>& upper,
                                              const Vec<Scalar>& moved) {
  const Vec<Scalar> facing = difference(upper.normal, lower.normal);
  const Scalar closing = minus(dot(moved, facing));
  return dot(difference(lower.x, upper.x), facing) - (closing > Scalar(0) ? closing : Scalar(0));
}

template <class Scalar>
[[gnu::always_inline]] inline Pair<Scalar> pair_of(const Place<Scalar>& lower, const Place<Scalar>& upper) {
  Pair<Scalar> p;
  p.apart = difference(lower.x, upper.x);
  const Vec<Scalar> facing = difference(upper.normal, lower.normal);
  const Scalar length = std::sqrt(dot(facing, facing));
  p.normal = contact::normalised(facing, length);
  const Vec<Scalar> start = difference(p.apart, difference(lower.moved, upper.moved));
  const Vec<Scalar> arm = times(scaled_sum(minus(dot(start, p.normal)), p.normal, start), Scalar(1) / length);
  const Scalar d = lower.density < upper.density ? lower.density : upper.density, longer = dot(arm, arm) * (d * d);
  p.arm = times(arm, longer > Scalar(1) ? Scalar(1) / longer : Scalar(1));
  p.gap = dot(p.apart, p.normal) + dot(p.arm, difference(upper.tilt, lower.tilt));
  return p;
}

/// The force on one point of a pair, in quanta; `f` acts on the lower one.
template <class Scalar>
[[gnu::always_inline]] inline Quanta quanta_of(const Vec<Scalar>& f, Scalar inverse, bool is_lower) {
  const Quanta q = contact::quanta(f, inverse);
  return is_lower ? q : Quanta{-q[0], -q[1], -q[2]};
}

/// Effect of the pushes on the tangents of a point, in quanta; `lever`: the sum of arms times pushes (touch_point.cl).
template <class Scalar>
inline void set_moment(std::int32_t* touch_moment, std::int64_t i, const Place<Scalar>& own, const Vec<Scalar>& lever,
                       Scalar inverse) {
  const std::array<Scalar, 2> turn = dual_of(own, lever);
  for (std::size_t k = 0; k < 2; ++k) {
    const Quanta q = contact::quanta(times(own.normal, turn[k] * own.density), inverse);
    std::int32_t* moment = touch_moment + i * PLIANT_TOUCH_MOMENT + 4 * k;
    std::copy(q.begin(), q.end(), moment);
    moment[3] = 0;
  }
}

/// Components of a vector in the frame that moves with the lower point, and the inverse.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> into_frame(const Place<Scalar>& lower, const Vec<Scalar>& v) {
  return {dot(lower.tangent, v), dot(cross(lower.normal, lower.tangent), v), dot(lower.normal, v)};
}
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> out_of_frame(const Place<Scalar>& lower, const Vec<Scalar>& v) {
  return scaled_sum(v[0], lower.tangent, scaled_sum(v[1], cross(lower.normal, lower.tangent), times(lower.normal, v[2])));
}

/// Tangential slip of a pair relative to its anchor.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> slip_of(const Place<Scalar>& lower, const Pair<Scalar>& p, const Vec<Scalar>& stuck) {
  const Vec<Scalar> slip = difference(p.apart, out_of_frame(lower, stuck));
  return scaled_sum(minus(dot(slip, p.normal)), p.normal, slip);
}

/// Access to the data of a partner: plane k of touch_pair.
template <class T>
inline T* pair_numbers(T* touch_pair, std::int64_t i, std::int64_t slot) {
  return touch_pair + tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_PAIR) + slot * PLIANT_TOUCH_PAIR * PLIANT_TILE;
}
template <class T>
inline T* pair_force(T* touch_force, std::int64_t i, std::int64_t slot) {
  return touch_force + tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + slot * PLIANT_TOUCH_FORCE * PLIANT_TILE;
}

}  // namespace pliant::ref::touch
