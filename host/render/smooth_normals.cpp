#include "render/smooth_normals.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/disjoint_sets.h"

namespace pliant::render {
namespace {

Vec3f point(std::span<const float> positions, std::int32_t vertex) {
  const std::size_t v = 3 * static_cast<std::size_t>(vertex);
  return {positions[v], positions[v + 1], positions[v + 2]};
}

Vec3f face_normal(std::span<const float> positions, std::span<const std::int32_t> triangles, std::size_t t) {
  const Vec3f a = point(positions, triangles[3 * t]);
  return cross(point(positions, triangles[3 * t + 1]) - a, point(positions, triangles[3 * t + 2]) - a);
}

struct HalfEdge {
  std::int32_t low, high;  ///< vertices
  std::int32_t corner_low, corner_high;
};

std::vector<HalfEdge> sorted_edges(std::span<const std::int32_t> triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(triangles.size());
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t next = c % 3 == 2 ? c - 2 : c + 1;
    auto from = std::pair{triangles[c], static_cast<std::int32_t>(c)};
    auto to = std::pair{triangles[next], static_cast<std::int32_t>(next)};
    if (from.first > to.first) std::swap(from, to);
    edges.push_back({from.first, to.first, from.second, to.second});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::pair{std::pair{a.low, a.high}, a.corner_low} < std::pair{std::pair{b.low, b.high}, b.corner_low};
  });
  return edges;
}

}  // namespace

SmoothNormals::SmoothNormals(std::span<const float> positions, std::span<const std::int32_t> triangles,
                             std::span<const std::uint8_t> kind, float crease) {
  const std::size_t count = triangles.size() / 3;
  std::vector<Vec3f> normal(count);
  for (std::size_t t = 0; t < count; ++t) normal[t] = unit(face_normal(positions, triangles, t), {0, 0, 0});
  DisjointSets sets(triangles.size());
  const std::vector<HalfEdge> edges = sorted_edges(triangles);
  const float least = std::cos(crease);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const HalfEdge &a = edges[e], &b = edges[e + 1];
    if (a.low != b.low || a.high != b.high) continue;
    const auto s = static_cast<std::size_t>(a.corner_low / 3), t = static_cast<std::size_t>(b.corner_low / 3);
    if (!kind.empty() && kind[s] != kind[t]) continue;
    // A degenerate triangle has no direction of its own: it joins its neighbours.
    if (dot(normal[s], normal[t]) < least && length(normal[s]) > 0 && length(normal[t]) > 0) continue;
    sets.join(a.corner_low, b.corner_low);
    sets.join(a.corner_high, b.corner_high);
  }
  corner_.assign(triangles.size(), -1);
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::int32_t root = sets.find(static_cast<std::int32_t>(c));
    if (corner_[root] < 0) {
      corner_[root] = static_cast<std::int32_t>(vertex_.size());
      vertex_.push_back(triangles[c]);
    }
    corner_[c] = corner_[root];
  }
}

std::vector<Vec3f> SmoothNormals::compute(std::span<const float> positions, std::span<const std::int32_t> triangles) const {
  std::vector<Vec3f> normal(count());
  for (std::size_t t = 0; t < triangles.size() / 3; ++t) {
    const Vec3f n = unit(face_normal(positions, triangles, t), {0, 0, 0});
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f here = point(positions, triangles[3 * t + i]);
      const Vec3f a = unit(point(positions, triangles[3 * t + (i + 1) % 3]) - here, {0, 0, 0});
      const Vec3f b = unit(point(positions, triangles[3 * t + (i + 2) % 3]) - here, {0, 0, 0});
      normal[static_cast<std::size_t>(corner_[3 * t + i])] += n * std::acos(std::fmin(std::fmax(dot(a, b), -1.0F), 1.0F));
    }
  }
  for (Vec3f& n : normal) n = unit(n);
  return normal;
}

}  // namespace pliant::render
