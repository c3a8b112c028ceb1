#include "geometry/surface_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/vec.h"

namespace pliant {
namespace {

constexpr double kWalkInside =
    1e-7;  ///< by which a section is moved into the triangle that it begins in, so that it crosses two edges
constexpr double kWalkHeld = 1e-5;  ///< a point this near to a triangle lies in it, too [edges]
constexpr double kWalkTie = 1e-9;   ///< by which another vertex has to be nearer [squares of an edge]

double longest_side(const std::array<Vec3d, 3>& c) {
  return std::max({vec::norm(vec::sub(c[1], c[0])), vec::norm(vec::sub(c[2], c[1])), vec::norm(vec::sub(c[0], c[2]))});
}

Vec3d walk_normal(const std::array<Vec3d, 3>& c) {
  const Vec3d n = vec::cross(vec::sub(c[1], c[0]), vec::sub(c[2], c[0]));
  const double size = vec::norm(n);
  return size > 0 ? vec::mul(n, 1 / size) : Vec3d{};
}

double way_length(const std::vector<WayPart>& way) {
  double sum = 0;
  for (const WayPart& part : way) sum += vec::norm(vec::sub(part.to, part.from));
  return sum;
}

}  // namespace

/// A plane, and on which side of it points are; a point in it is above.
struct SurfaceWalk::Section {
  Vec3d normal{};
  double offset = 0;
  [[nodiscard]] double above(const Vec3d& p) const { return vec::dot(normal, p) - offset; }
  [[nodiscard]] bool crosses(const Vec3d& a, const Vec3d& b) const { return (above(a) >= 0) != (above(b) >= 0); }
  [[nodiscard]] Vec3d crossing(const Vec3d& a, const Vec3d& b) const {
    const double at = above(a), share = at / (at - above(b));
    return vec::add(a, vec::mul(vec::sub(b, a), share));
  }
};

SurfaceWalk::SurfaceWalk(TriangleMesh mesh) : mesh_(std::move(mesh)), tree_(mesh_), next_(mesh_.triangles.size()) {
  struct DirectedEdge {
    std::int32_t a = 0, b = 0, triangle = 0;
    [[nodiscard]] bool operator<(const DirectedEdge& e) const { return std::pair(a, b) < std::pair(e.a, e.b); }
  };
  std::vector<DirectedEdge> edges;
  for (std::size_t t = 0; t < next_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3], static_cast<std::int32_t>(t)});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t t = 0; t < next_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
      const auto own = std::equal_range(edges.begin(), edges.end(), DirectedEdge{a, b});
      const auto other = std::equal_range(edges.begin(), edges.end(), DirectedEdge{b, a});
      next_[t][k] = own.second - own.first == 1 && other.second - other.first == 1 ? other.first->triangle : -1;
    }
  }
}

std::array<Vec3d, 3> SurfaceWalk::corners(std::int32_t triangle) const {
  const auto& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
  return {mesh_.vertices[static_cast<std::size_t>(t[0])], mesh_.vertices[static_cast<std::size_t>(t[1])],
          mesh_.vertices[static_cast<std::size_t>(t[2])]};
}

std::int32_t SurfaceWalk::vertex_at(const SurfacePoint& p) const {
  const std::vector<VertexOnWay> found = vertices({{p.triangle, p.at, p.at}}, -1);
  return found.front().vertex;
}

bool SurfaceWalk::holds(std::int32_t triangle, const SurfacePoint& p) const {
  if (triangle == p.triangle) return true;
  const std::array<Vec3d, 3> c = corners(triangle);
  return vec::norm(vec::sub(closest_on_triangle(p.at, c[0], c[1], c[2]), p.at)) <= kWalkHeld * longest_side(c);
}

std::optional<std::vector<WayPart>> SurfaceWalk::march(const SurfacePoint& from, const SurfacePoint& to, const Section& section,
                                                       int exit, double most) const {
  std::vector<WayPart> way;
  double length = 0;
  std::int32_t t = from.triangle;
  Vec3d x = from.at;
  while (!holds(t, to)) {
    if (way.size() > mesh_.triangles.size()) return {};
    const std::array<Vec3d, 3> c = corners(t);
    const auto k = static_cast<std::size_t>(exit);
    const Vec3d y = section.crossing(c[k], c[(k + 1) % 3]);
    way.push_back({t, x, y});
    length += vec::norm(vec::sub(y, x));
    const std::int32_t next = next_[static_cast<std::size_t>(t)][k];
    if (next < 0 || length > most) return {};
    const auto& before = mesh_.triangles[static_cast<std::size_t>(t)];
    const auto& there = mesh_.triangles[static_cast<std::size_t>(next)];
    const std::array<Vec3d, 3> d = corners(next);
    exit = -1;
    for (std::size_t e = 0; e < 3; ++e) {
      if (there[e] == before[(k + 1) % 3] && there[(e + 1) % 3] == before[k]) continue;  // it comes in here
      if (section.crosses(d[e], d[(e + 1) % 3])) exit = static_cast<int>(e);
    }
    if (exit < 0) return {};
    t = next;
    x = y;
  }
  if (length + vec::norm(vec::sub(to.at, x)) > most) return {};
  way.push_back({t, x, to.at});
  return way;
}

std::optional<std::vector<WayPart>> SurfaceWalk::way(const SurfacePoint& from, const SurfacePoint& to, double most) const {
  if (holds(from.triangle, to)) return std::vector<WayPart>{{from.triangle, from.at, to.at}};
  const std::array<Vec3d, 3> c = corners(from.triangle);
  const Vec3d up = vec::add(walk_normal(c), walk_normal(corners(to.triangle)));
  Section section{vec::cross(vec::sub(to.at, from.at), up), 0};
  const double size = vec::norm(section.normal);
  if (!(size > 0)) return {};
  section.normal = vec::mul(section.normal, 1 / size);
  const Vec3d middle = vec::mul(vec::add(vec::add(c[0], c[1]), c[2]), 1.0 / 3);
  section.offset = vec::dot(section.normal, vec::add(from.at, vec::mul(vec::sub(middle, from.at), kWalkInside)));
  std::optional<std::vector<WayPart>> best;
  for (int k = 0; k < 3; ++k) {
    if (!section.crosses(c[static_cast<std::size_t>(k)], c[static_cast<std::size_t>((k + 1) % 3)])) continue;
    std::optional<std::vector<WayPart>> found = march(from, to, section, k, most);
    if (!found) continue;
    most = std::min(most, way_length(*found));
    best = std::move(found);
  }
  return best;
}

std::vector<VertexOnWay> SurfaceWalk::vertices(const std::vector<WayPart>& way, std::int32_t first) const {
  std::vector<VertexOnWay> out;
  std::int32_t now = first;
  const double whole = way_length(way);
  double before = 0;
  for (const WayPart& part : way) {
    const auto& names = mesh_.triangles[static_cast<std::size_t>(part.triangle)];
    const std::array<Vec3d, 3> c = corners(part.triangle);
    const Vec3d motion = vec::sub(part.to, part.from);
    const double tie = kWalkTie * longest_side(c) * longest_side(c), length = vec::norm(motion);
    // At the share s of this part the square of the distance from corner k is a[k] + s b[k], less the same term for all.
    std::array<double, 3> a{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d d = vec::sub(c[k], part.from);
      a[k] = vec::dot(d, d);
      b[k] = -2 * vec::dot(motion, d);
    }
    const auto come_to = [&](std::size_t k, double s) {
      if (names[k] == now) return;
      now = names[k];
      out.push_back({now, vec::add(part.from, vec::mul(motion, s)), whole > 0 ? (before + s * length) / whole : 0});
    };
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (std::pair(a[k], names[k]) < std::pair(a[nearest], names[nearest])) nearest = k;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (names[k] == now && a[k] <= a[nearest] + tie) nearest = k;
    }
    come_to(nearest, 0);
    for (double s = 0; s <= 1;) {
      double soonest = 2;
      std::size_t other = nearest;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!(b[k] < b[nearest])) continue;
        const double at = std::max(s, (a[k] - a[nearest] + tie) / (b[nearest] - b[k]));
        if (at < soonest) soonest = at, other = k;
      }
      s = soonest;
      if (s <= 1) come_to(nearest = other, s);
    }
    before += length;
  }
  return out;
}

}  // namespace pliant
