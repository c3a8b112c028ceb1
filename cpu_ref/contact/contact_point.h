// Twin of contact_point.cl, press_lanes.cl and tool_lanes.cl, which describe the computation (kernels/contact).
#pragma once
#include "cpu_ref/contact/contact_shape.h"
#include "cpu_ref/tile.h"

namespace pliant::ref::contact {

inline constexpr std::int64_t pose_numbers = 15;

template <class Scalar>
struct Place {
  Vec<Scalar> now{}, moved{};
};

/// The buffers that determine the position of a point.
template <class Scalar>
struct Points {
  const Scalar *node_u, *node_w, *rest;
  const std::int32_t* node;
  const Scalar* weight;

  [[nodiscard]] Place<Scalar> at(std::int64_t i) const {
    const std::int64_t base = tile_base(i, 8), own = tile_base(i, 4);
    Place<Scalar> p;
    for (std::int64_t a = 0; a < 8; ++a) {
      const Scalar c = weight[base + a * PLIANT_TILE];
      const std::int64_t texel = std::int64_t{4} * node[base + a * PLIANT_TILE];
      for (std::size_t k = 0; k < 3; ++k) {
        p.now[k] = std::fma(c, node_u[texel + static_cast<std::int64_t>(k)], p.now[k]);
        p.moved[k] = std::fma(c, node_w[texel + static_cast<std::int64_t>(k)], p.moved[k]);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) p.now[k] = rest[own + static_cast<std::int64_t>(k) * PLIANT_TILE] + p.now[k];
    return p;
  }
  [[nodiscard]] Scalar area(std::int64_t i) const { return rest[tile_base(i, 4) + std::int64_t{3} * PLIANT_TILE]; }
};

template <class Scalar>
inline Vec<Scalar> turned(const Scalar* r, const Vec<Scalar>& v) {
  return {dot({r[0], r[1], r[2]}, v), dot({r[3], r[4], r[5]}, v), dot({r[6], r[7], r[8]}, v)};
}
template <class Scalar>
inline Vec<Scalar> turned_back(const Scalar* r, const Vec<Scalar>& v) {
  return {dot({r[0], r[3], r[6]}, v), dot({r[1], r[4], r[7]}, v), dot({r[2], r[5], r[8]}, v)};
}
template <class Scalar>
inline Vec<Scalar> origin_of(const Scalar* pose) {
  return {pose[9], pose[10], pose[11]};
}

/// Fraction of the margin within which a point may touch in the next step. It is larger for points that were within it
/// before, so that the set of these points does not flicker.
template <class Scalar>
inline Scalar ready_share(Scalar yield) {
  return yield > Scalar(0) ? Scalar(0.24) : Scalar(0.08);
}

template <class Scalar>
struct Meeting {
  Scalar distance = 0, opening = 0;
  Vec<Scalar> normal{}, slip{}, inside{};
  /// Returns whether the point may touch the tool in the next step.
  [[nodiscard]] bool may_touch_next(Scalar margin, Scalar share) const {
    return distance < std::fma(share, margin, opening < Scalar(0) ? -opening : Scalar(0));
  }
};

/// The tools of a step.
template <class Scalar>
struct Tools {
  const std::int32_t* kind;
  const Scalar *data, *grid, *pose;
  std::int32_t count, step;

  [[nodiscard]] const Scalar* law(std::int32_t t) const { return data + tool_numbers * t; }
  [[nodiscard]] const Scalar* now(std::int32_t t) const { return &pose[pose_numbers * (std::int64_t{step} * count + t)]; }
  [[nodiscard]] const Scalar* next(std::int32_t t) const { return now(t) + pose_numbers * count; }
  [[nodiscard]] Meeting<Scalar> meet(std::int32_t t, const Place<Scalar>& p) const {
    Meeting<Scalar> m;
    const std::int32_t* own = kind + tool_integers * t;
    const Vec<Scalar> start = turned_back(now(t), difference(difference(p.now, p.moved), origin_of(now(t))));
    m.inside = turned_back(next(t), difference(p.now, origin_of(next(t))));
    const Surface<Scalar> found = tool_distance(own, law(t), grid, next(t) + 12, start);
    const Vec<Scalar> way = difference(m.inside, start);
    m.opening = dot(found.normal, way);
    m.distance = found.distance + m.opening;
    m.normal = turned(next(t), found.normal);
    m.slip = turned(now(t), way);
    if (own[5] > 1) m.opening = m.opening + (found.distance - tool_distance(own, law(t), grid, now(t) + 12, start).distance);
    return m;
  }
};

/// The depth that a point has through its held nodes. `at`: the place of the meeting.
template <class Scalar>
inline Scalar held_depth(const Points<Scalar>& points, const Scalar* contact_share, const Scalar* contact_held, std::int64_t i,
                         const Vec<Scalar>& at, const Meeting<Scalar>& m) {
  const Scalar *held = contact_held + tile_base(i, 4), part = held[std::int64_t{3} * PLIANT_TILE];
  if (!(part > Scalar(0))) return 0;
  Vec<Scalar> u{};
  for (std::int64_t a = 0, base = tile_base(i, 8); a < 8; ++a) {
    const std::int64_t plane = base + a * PLIANT_TILE, texel = std::int64_t{4} * points.node[plane];
    if (contact_share[plane] > Scalar(0)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      u[k] = std::fma(points.weight[plane], points.node_u[texel + static_cast<std::int64_t>(k)], u[k]);
  }
  Vec<Scalar> place;
  for (std::size_t k = 0; k < 3; ++k) place[k] = held[static_cast<std::int64_t>(k) * PLIANT_TILE] + u[k];
  const Scalar distance = std::fma(part, m.distance, dot(m.normal, scaled_sum(-part, at, place)));
  return distance < Scalar(0) ? -distance : Scalar(0);
}

/// The depth in tool t that an edit has left a point. `start`: two numbers; `before`: depth at the start of the step; `given`:
/// by how much it gets less in a step. Where the step has become shorter, the numbers say how much of the rest of the depth is
/// left, too.
template <class Scalar>
inline Scalar start_depth(const Scalar* start, std::int32_t t, Scalar before, Scalar given) {
  const Scalar had = start[0], of = start[PLIANT_TILE], whole = std::floor(of);
  const bool in_it = static_cast<std::int32_t>(whole) == t + 1;
  const Scalar own = had < Scalar(0) ? -had * before : in_it ? std::fma(of - whole, before - had, had - given) : Scalar(0);
  const Scalar depth = before < own ? before : own;
  return depth > Scalar(0) ? depth : Scalar(0);
}

/// The same of all tools of a point, of which the deepest is kept.
template <class Scalar>
struct LeftDeep {
  Scalar* start;
  Scalar lag = 0, lag_in = 0;
  Scalar in(std::int32_t t, Scalar before, Scalar given) {
    const Scalar own = start_depth(start, t, before, given);
    if (own > lag) lag = own, lag_in = static_cast<Scalar>(t + 1);
    return own;
  }
  void keep() const { start[0] = lag, start[PLIANT_TILE] = lag_in; }
};
template <class Scalar>
inline Scalar left_in(const Scalar* start, std::int32_t t) {
  return start[PLIANT_TILE] == static_cast<Scalar>(t + 1) ? start[0] : Scalar(0);
}

inline constexpr double quantum_limit = 67108864.0;

template <class Scalar>
[[gnu::always_inline]] inline std::int32_t quanta(Scalar value) {
  const auto limit = static_cast<Scalar>(quantum_limit);
  const Scalar inside = value > limit ? limit : value < -limit ? -limit : value;
  return std::isnan(inside) ? 0 : static_cast<std::int32_t>(std::rint(inside));
}

/// A point's four numbers in a tile.
template <class T>
struct PointNumbers {
  T* base;
  T& operator[](std::int64_t plane) const { return base[plane * PLIANT_TILE]; }
};
template <class T>
inline PointNumbers<T> numbers_of(T* buffer, std::int64_t i) {
  return {buffer + tile_base(i, 4)};
}

}  // namespace pliant::ref::contact
