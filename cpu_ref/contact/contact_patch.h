// Twin of kernels/contact/contact_patch.cl, which describes the computation.
#pragma once
#include "cpu_ref/contact/contact_sum.h"
#include "cpu_ref/contact/touch_point.h"

namespace pliant::ref::contact {

inline constexpr std::int64_t patch_sides = 6;

/// A place on a patch.
template <class Scalar>
struct PatchPlace {
  std::array<Scalar, 8> weight{};
  Vec<Scalar> now{}, moved{}, first{}, second{};
};

/// The tangent plane at a place, in a tool's frame.
template <class Scalar>
struct PatchPlane {
  Vec<Scalar> y{}, normal{};
  std::array<Vec<Scalar>, 2> dual{};
  bool flat = false;
};

template <class Scalar>
inline PatchPlane<Scalar> plane_of(const PatchPlace<Scalar>& p, const Scalar* now) {
  PatchPlane<Scalar> out;
  out.y = turned_back(now, difference(difference(p.now, p.moved), origin_of(now)));
  const Vec<Scalar> first = turned_back(now, p.first), second = turned_back(now, p.second);
  const Vec<Scalar> across = touch::cross(first, second);
  const Scalar area = std::sqrt(dot(across, across)), inverse = area > Scalar(0) ? Scalar(1) / area : Scalar(0);
  out.normal = normalised(across, area);
  out.dual = {times(touch::cross(second, out.normal), inverse), times(touch::cross(out.normal, first), inverse)};
  out.flat = area > Scalar(0);
  return out;
}

/// The patches around points.
template <class Scalar>
struct Patches {
  Points<Scalar> points;
  const Scalar *surface, *patch;

  [[nodiscard]] const Scalar* region(std::int64_t i) const { return patch + tile_base(i, PLIANT_PATCH); }
  [[nodiscard]] bool joined(std::int64_t i) const {
    return std::fabs(patch[tile_base(i, PLIANT_PATCH) + std::int64_t{33} * PLIANT_TILE]) > Scalar(1.5);
  }
  [[nodiscard]] Scalar spacing(std::int64_t i) const {
    return surface[tile_base(i, PLIANT_TOUCH_SURFACE) + std::int64_t{22} * PLIANT_TILE];
  }
  [[nodiscard]] Scalar reach(std::int64_t i) const {
    return surface[tile_base(i, PLIANT_TOUCH_SURFACE) + std::int64_t{23} * PLIANT_TILE];
  }
  [[nodiscard]] PatchPlace<Scalar> at(std::int64_t i, Scalar a, Scalar b) const {
    const std::int64_t own = tile_base(i, PLIANT_TOUCH_SURFACE), base = tile_base(i, 8), cell = tile_base(i, PLIANT_PATCH);
    const bool trilinear = patch[cell + std::int64_t{33} * PLIANT_TILE] > Scalar(0);
    const Vec<Scalar> along_a = touch::three(patch, cell, 27), along_b = touch::three(patch, cell, 30);
    const Vec<Scalar> local = scaled_sum(a, along_a, scaled_sum(b, along_b, touch::three(patch, cell, 24)));
    const Vec<Scalar> t1 = touch::three(surface, own, 16), t2 = touch::three(surface, own, 19);
    PatchPlace<Scalar> p;
    Vec<Scalar> u{};
    for (std::int64_t k = 0; k < 8; ++k) {
      Scalar da = surface[own + k * PLIANT_TILE], db = surface[own + (8 + k) * PLIANT_TILE];
      Scalar w = std::fma(a, da, std::fma(b, db, points.weight[base + k * PLIANT_TILE]));
      if (trilinear) {
        Vec<Scalar> s{}, f{};
        for (std::size_t c = 0; c < 3; ++c) {
          const bool high = (k >> c & 1) != 0;
          s[c] = high ? Scalar(1) : Scalar(-1);
          f[c] = high ? local[c] : Scalar(1) - local[c];
        }
        const auto slope = [&](const Vec<Scalar>& along) {
          return std::fma(s[0] * along[0], f[1] * f[2],
                          std::fma(s[1] * along[1], f[0] * f[2], (s[2] * along[2]) * (f[0] * f[1])));
        };
        w = (f[0] * f[1]) * f[2];
        da = slope(along_a);
        db = slope(along_b);
      }
      const std::int64_t texel = std::int64_t{4} * points.node[base + k * PLIANT_TILE];
      const Scalar *whole = points.node_u + texel, *moved = points.node_w + texel;
      const Vec<Scalar> before{whole[0] - moved[0], whole[1] - moved[1], whole[2] - moved[2]};
      p.weight[static_cast<std::size_t>(k)] = w;
      u = scaled_sum(w, {whole[0], whole[1], whole[2]}, u);
      p.moved = scaled_sum(w, {moved[0], moved[1], moved[2]}, p.moved);
      p.first = scaled_sum(da, before, p.first);
      p.second = scaled_sum(db, before, p.second);
    }
    p.now = sum_of(scaled_sum(a, t1, scaled_sum(b, t2, touch::three(points.rest, tile_base(i, 4), 0))), u);
    p.first = sum_of(t1, p.first);
    p.second = sum_of(t2, p.second);
    return p;
  }
};

/// Distance of (a, b) from a region relative to the patch's margin; negative inside.
template <class Scalar>
inline Scalar beyond_region(const Scalar* sides, Scalar a, Scalar b) {
  Scalar most = -Scalar(1e30);
  for (std::int64_t k = 0; k < patch_sides; ++k, sides += std::int64_t{4} * PLIANT_TILE) {
    const Scalar out = std::fma(sides[0], a, std::fma(sides[PLIANT_TILE], b, -sides[std::int64_t{2} * PLIANT_TILE])) /
                       sides[std::int64_t{3} * PLIANT_TILE];
    most = out > most ? out : most;
  }
  return most;
}

}  // namespace pliant::ref::contact
