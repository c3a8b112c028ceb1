// Positions at which a segment crosses triangles, and their order along it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/predicates.h"

namespace pliant::overlay {

/// Where the segment from p to q meets the plane of (a, b, c), kept between p and q [m].
inline Vec3d on_plane(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d n = vec::cross(vec::sub(b, a), vec::sub(c, a));
  const double u = vec::dot(n, vec::sub(p, a)), w = vec::dot(n, vec::sub(q, a));
  const double t = u != w ? std::clamp(u / (u - w), 0.0, 1.0) : 0.5;
  return vec::add(p, vec::mul(vec::sub(q, p), t));
}

/// Whether all corners of `b` that `a` does not have lie on one side of a's plane: that side; 0 if they lie on both.
inline int side_of(const std::array<ExactPoint, 3>& a, const std::array<ExactPoint, 3>& b) {
  int side = 0;
  for (const ExactPoint& p : b) {
    if (p.id == a[0].id || p.id == a[1].id || p.id == a[2].id) continue;
    const int s = orient(a[0], a[1], a[2], p);
    if (side != 0 && s != side) return 0;
    side = s;
  }
  return side;
}

/// Sorts the crossings of a segment from u to w. `triangle(item)` gives the triangle crossed, `position(item)` the place [m].
/// Exact whenever one of two triangles lies on one side of the other's plane.
template <class Item, class Ends, class Triangle, class Position>
void sort_along(std::vector<Item>& items, const Ends& u, const Ends& w, const Triangle& triangle, const Position& position) {
  const auto before = [&](const Item& x, const Item& y) {
    const auto a = triangle(x), b = triangle(y);
    if (const int side = side_of(a, b); side != 0) return orient(a[0], a[1], a[2], u.exact) != side;
    if (const int side = side_of(b, a); side != 0) return orient(b[0], b[1], b[2], u.exact) == side;
    const Vec3d d = vec::sub(w.x, u.x);
    return vec::dot(d, position(x)) < vec::dot(d, position(y));
  };
  for (std::size_t i = 1; i < items.size(); ++i) {  // few items, and the order may be intransitive by rounding
    for (std::size_t j = i; j > 0 && before(items[j], items[j - 1]); --j) std::swap(items[j], items[j - 1]);
  }
}

}  // namespace pliant::overlay
