// Twin of kernels/contact/contact_shape.cl, which describes the computation.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "cpu_ref/minus.h"

namespace pliant::ref::contact {

inline constexpr std::int64_t tool_numbers = 20, tool_integers = 8;
inline constexpr std::int32_t face_of_blade = 6;

template <class Scalar>
using Vec = std::array<Scalar, 3>;

template <class Scalar>
[[gnu::always_inline]] inline Scalar dot(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return std::fma(a[0], b[0], std::fma(a[1], b[1], a[2] * b[2]));
}
template <class Scalar>
inline Scalar mixed(Scalar a, Scalar b, Scalar t) {
  return std::fma(t, b - a, a);
}
/// s a + b.
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> scaled_sum(Scalar s, const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return {std::fma(s, a[0], b[0]), std::fma(s, a[1], b[1]), std::fma(s, a[2], b[2])};
}
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> difference(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> sum_of(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> times(const Vec<Scalar>& a, Scalar s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

template <class Scalar>
struct Surface {
  Vec<Scalar> normal{};
  Scalar distance = 0;
};

template <class Scalar>
[[gnu::always_inline]] inline Vec<Scalar> normalised(const Vec<Scalar>& v, Scalar length) {
  return length > Scalar(0) ? Vec<Scalar>{v[0] / length, v[1] / length, v[2] / length} : Vec<Scalar>{0, 0, 1};
}

template <class Scalar>
Surface<Scalar> grid_distance(const std::int32_t* kind, const Scalar* data, const Scalar* grid, const Vec<Scalar>& y) {
  const std::int32_t* size = kind + 2;
  const Scalar spacing = data[11];
  Vec<Scalar> beyond{}, t{};
  std::array<std::int64_t, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a) {
    const Scalar g = (y[a] - data[7 + a]) * data[10], most = static_cast<Scalar>(size[a] - 1);
    const Scalar inside = g > Scalar(0) ? (g < most ? g : most) : Scalar(0);
    beyond[a] = g - inside;
    const auto low = static_cast<std::int32_t>(inside);
    cell[a] = low < size[a] - 2 ? low : size[a] - 2;
    t[a] = inside - static_cast<Scalar>(cell[a]);
  }
  const Scalar beyond2 = dot(beyond, beyond);
  if (beyond2 > Scalar(0)) return {{0, 0, 1}, std::fma(Scalar(2), spacing, std::sqrt(beyond2) * spacing)};
  const std::int64_t row = size[0], plane = row * size[1];
  const Scalar* v = grid + cell[2] * plane + cell[1] * row + cell[0];
  const auto at = [&](int i, int j, int k) { return v[i + j * row + k * plane]; };
  Scalar edge[2][2], slope[2][2];
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      edge[k][j] = mixed(at(0, j, k), at(1, j, k), t[0]);
      slope[k][j] = at(1, j, k) - at(0, j, k);
    }
  }
  const Scalar low = mixed(edge[0][0], edge[0][1], t[1]), high = mixed(edge[1][0], edge[1][1], t[1]);
  const Vec<Scalar> gradient{mixed(mixed(slope[0][0], slope[0][1], t[1]), mixed(slope[1][0], slope[1][1], t[1]), t[2]),
                             mixed(edge[0][1] - edge[0][0], edge[1][1] - edge[1][0], t[2]), high - low};
  return {normalised(gradient, std::sqrt(dot(gradient, gradient))), mixed(low, high, t[2])};
}

template <class Scalar>
Surface<Scalar> box_distance(const Scalar* half, const Vec<Scalar>& y) {
  Vec<Scalar> q{}, p{};
  for (std::size_t a = 0; a < 3; ++a) {
    q[a] = std::fabs(y[a]) - half[a];
    p[a] = q[a] > Scalar(0) ? q[a] : Scalar(0);
  }
  Scalar length = std::sqrt(dot(p, p)), distance = length;
  if (!(length > Scalar(0))) {
    const std::size_t face = q[0] >= q[1] && q[0] >= q[2] ? 0 : q[1] >= q[2] ? 1 : 2;
    distance = q[face];
    p[face] = 1;
    length = 1;
  }
  for (std::size_t a = 0; a < 3; ++a) p[a] = std::copysign(p[a], y[a]);
  return {normalised(p, length), distance};
}

/// Interpolates two frames of a sequence.
template <class Scalar>
Surface<Scalar> mesh_distance(const std::int32_t* kind, const Scalar* data, const Scalar* tool_grid, const Scalar* moment,
                              const Vec<Scalar>& y) {
  const Scalar* grid = tool_grid + kind[1];
  if (kind[5] < 2) return grid_distance(kind, data, grid, y);
  const std::int64_t nodes = std::int64_t{kind[2]} * kind[3] * kind[4];
  grid += static_cast<std::int64_t>(moment[0]) * nodes;
  const Surface<Scalar> now = grid_distance(kind, data, grid, y);
  if (!(moment[1] > Scalar(0))) return now;
  const Surface<Scalar> after = grid_distance(kind, data, grid + nodes, y);
  Vec<Scalar> n{};
  for (std::size_t a = 0; a < 3; ++a) n[a] = mixed(now.normal[a], after.normal[a], moment[1]);
  return {normalised(n, std::sqrt(dot(n, n))), mixed(now.distance, after.distance, moment[1])};
}

template <class Scalar>
Surface<Scalar> tool_distance(const std::int32_t* kind, const Scalar* data, const Scalar* tool_grid, const Scalar* moment,
                              const Vec<Scalar>& y) {
  const Vec<Scalar> first{data[1], data[2], data[3]}, second{data[4], data[5], data[6]};
  if (kind[0] == 2 || kind[0] == face_of_blade) return box_distance(data + 4, y);
  if (kind[0] == 3) return {second, dot(difference(y, first), second)};
  if (kind[0] == 4) return mesh_distance(kind, data, tool_grid, moment, y);
  Vec<Scalar> from = y;
  if (kind[0] == 1) {
    const Vec<Scalar> axis = difference(second, first);
    from = difference(y, first);
    const Scalar t = dot(from, axis) / dot(axis, axis);
    const Scalar s = t > Scalar(0) ? (t < Scalar(1) ? t : Scalar(1)) : Scalar(0);
    from = scaled_sum(-s, axis, from);
  }
  const Scalar length = std::sqrt(dot(from, from));
  return {normalised(from, length), length - data[0]};
}

}  // namespace pliant::ref::contact
