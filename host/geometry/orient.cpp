#include "geometry/orient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "geometry/triangle_tree.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

struct HalfEdge {
  std::int32_t low, high;  // vertices, low < high
  std::int32_t triangle;
  bool forward;  // the triangle runs from low to high
};

// A shell is opposite to another one on purpose only if this share of its area says so.
constexpr double kMajority = 0.75;
// Triangles at an edge closer than this [rad] lie on each other.
constexpr double kSameAngle = 1e-6;
// An edge of more triangles is no place where parts meet, and all ways to pair them would be too many.
constexpr std::size_t kMostAtEdge = 10;

struct Shell {
  std::vector<std::int32_t> triangles;
  double volume = 0;   // signed, with the winding the flood gave [m^3]
  double area = 0;     // [m^2]
  double flipped = 0;  // area that the flood reversed [m^2]
  vec::Box box;
  Vec3d vertex{};
  std::unique_ptr<TriangleTree> tree;
  /// Sign of the volume as the file wound it; 0 if the file contradicts itself.
  [[nodiscard]] int given() const {
    const int sign = volume < 0 ? -1 : 1;
    return flipped <= (1 - kMajority) * area ? sign : flipped >= kMajority * area ? -sign : 0;
  }
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      const std::int32_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::array{x.low, x.high, x.triangle} < std::array{y.low, y.high, y.triangle};
  });
  return edges;
}

struct Link {
  std::int32_t triangle = -1;
  bool opposite = false;  // the two triangles run the shared edge in the same direction: one must be flipped
};

// At an edge of more than two triangles, as many of them running up as down, each of the first bounds material together with
// one of the second. Of all ways to pair them the best is the straightest one (surfaces that cross go on), of these the one
// with the narrowest wedges of material, and none pairs triangles that lie on each other: so parts that touch or overlap stay
// apart, also where one of them is inside out.
std::vector<std::array<std::size_t, 2>> wedges(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges, std::size_t first,
                                               std::size_t last) {
  const Vec3d& from = mesh.vertices[edges[first].low];
  const Vec3d along = vec::sub(mesh.vertices[edges[first].high], from);
  const Vec3d axis = vec::mul(along, 1 / vec::norm(along));
  Vec3d zero{};
  std::vector<double> angle;  // about the edge, from its first triangle
  std::vector<std::size_t> up, down;
  for (std::size_t i = first; i < last; ++i) {
    const auto& t = mesh.triangles[edges[i].triangle];
    const auto third = std::find_if(t.begin(), t.end(), [&](auto v) { return v != edges[i].low && v != edges[i].high; });
    const Vec3d d = vec::sub(mesh.vertices[*third], from), across = vec::sub(d, vec::mul(axis, vec::dot(axis, d)));
    if (i == first) zero = across;
    angle.push_back(std::atan2(vec::dot(axis, vec::cross(zero, across)), vec::dot(zero, across)));
    (edges[i].forward ? up : down).push_back(i);
  }
  const auto cost = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < up.size(); ++i) {
      double wedge = angle[up[i] - first] - angle[down[i] - first];
      if (wedge < -kSameAngle) wedge += 2 * std::numbers::pi;
      const bool closed = wedge < kSameAngle || wedge > 2 * std::numbers::pi - kSameAngle;
      sum += closed ? 100 : std::abs(wedge - std::numbers::pi) + 1e-3 * wedge;
    }
    return sum;
  };
  std::vector<std::size_t> best = down;
  double least = HUGE_VAL;
  do {
    const double now = cost();
    if (now < least - kSameAngle) {
      least = now;
      best = down;
    }
  } while (std::next_permutation(down.begin(), down.end()));
  std::vector<std::array<std::size_t, 2>> out;
  for (std::size_t i = 0; i < up.size(); ++i) out.push_back({up[i], best[i]});
  return out;
}

// Neighbours over edges that exactly two triangles share, or evenly many that run it equally often both ways.
std::vector<std::array<Link, 3>> neighbours(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  std::vector<std::array<Link, 3>> links(mesh.triangles.size());
  std::vector<int> used(mesh.triangles.size(), 0);
  const auto link = [&](const HalfEdge& x, const HalfEdge& y) {
    links[x.triangle][used[x.triangle]++] = {y.triangle, x.forward == y.forward};
    links[y.triangle][used[y.triangle]++] = {x.triangle, x.forward == y.forward};
  };
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i, forward = 0;
    for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high; ++end) {
      forward += edges[end].forward ? 1 : 0;
    }
    if (end - i == 2) {
      link(edges[i], edges[i + 1]);
    } else if (2 * forward == end - i && end - i <= kMostAtEdge) {
      for (const auto& [up, down] : wedges(mesh, edges, i, end)) link(edges[up], edges[down]);
    }
    i = end;
  }
  return links;
}

double area_of(const TriangleMesh& mesh, std::int32_t t) {
  const auto& v = mesh.triangles[t];
  return vec::norm(vec::cross(vec::sub(mesh.vertices[v[1]], mesh.vertices[v[0]]),
                              vec::sub(mesh.vertices[v[2]], mesh.vertices[v[0]]))) /
         2;
}

void flip(TriangleMesh& mesh, std::int32_t t) { std::swap(mesh.triangles[t][1], mesh.triangles[t][2]); }

// Wind each shell consistently with its first triangle.
std::vector<Shell> flood(TriangleMesh& mesh, OrientationReport& report, std::vector<char>& flipped) {
  const auto links = neighbours(mesh);
  report.shell.assign(mesh.triangles.size(), -1);
  std::vector<Shell> shells;
  std::vector<std::int32_t> queue;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (report.shell[seed] >= 0) continue;
    const auto id = static_cast<std::int32_t>(shells.size());
    Shell& shell = shells.emplace_back();
    queue.assign(1, static_cast<std::int32_t>(seed));
    report.shell[seed] = id;
    while (!queue.empty()) {
      const std::int32_t t = queue.back();
      queue.pop_back();
      shell.triangles.push_back(t);
      shell.area += area_of(mesh, t);
      if (flipped[t] != 0) shell.flipped += area_of(mesh, t);
      for (const Link& link : links[t]) {
        if (link.triangle < 0 || report.shell[link.triangle] >= 0) continue;
        report.shell[link.triangle] = id;
        flipped[link.triangle] = static_cast<char>((flipped[t] != 0) != link.opposite);
        if (flipped[link.triangle] != 0) flip(mesh, link.triangle);
        queue.push_back(link.triangle);
      }
    }
  }
  report.shells = static_cast<std::int32_t>(shells.size());
  return shells;
}

std::vector<std::array<std::int32_t, 2>> rim_of(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  std::vector<std::array<std::int32_t, 2>> rim;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    int balance = 0;
    for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high; ++end) {
      balance += edges[end].forward ? 1 : -1;
    }
    if (balance != 0) rim.push_back({edges[i].low, edges[i].high});
    i = end;
  }
  return rim;
}

void measure(const TriangleMesh& mesh, Shell& shell) {
  Vec3d centre{};
  for (const std::int32_t t : shell.triangles) {
    for (const std::int32_t v : mesh.triangles[t]) {
      shell.box.extend(mesh.vertices[v]);
      centre = vec::add(centre, vec::mul(mesh.vertices[v], area_of(mesh, t) / 3));
    }
  }
  if (shell.area > 0) centre = vec::mul(centre, 1 / shell.area);
  for (const std::int32_t t : shell.triangles) {
    const auto& v = mesh.triangles[t];
    const Vec3d a = vec::sub(mesh.vertices[v[0]], centre), b = vec::sub(mesh.vertices[v[1]], centre);
    shell.volume += vec::dot(a, vec::cross(b, vec::sub(mesh.vertices[v[2]], centre))) / 6;
  }
  shell.vertex = mesh.vertices[mesh.triangles[*std::min_element(shell.triangles.begin(), shell.triangles.end())][0]];
}

bool encloses(const TriangleMesh& mesh, Shell& outer, const Shell& inner) {
  for (int a = 0; a < 3; ++a) {
    if (inner.box.lower[a] < outer.box.lower[a] || inner.box.upper[a] > outer.box.upper[a]) return false;
  }
  if (!outer.tree) {
    TriangleMesh part;
    part.vertices = mesh.vertices;
    for (const std::int32_t t : outer.triangles) part.triangles.push_back(mesh.triangles[t]);
    outer.tree = std::make_unique<TriangleTree>(part);
  }
  return std::abs(outer.tree->winding(inner.vertex)) > 0.5;
}

}  // namespace

OrientationReport orient_outward(TriangleMesh& mesh) {
  OrientationReport report;
  std::vector<char> flipped(mesh.triangles.size(), 0);
  std::vector<Shell> shells = flood(mesh, report, flipped);
  for (Shell& shell : shells) measure(mesh, shell);
  std::vector<std::size_t> order(shells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(shells[a].volume) > std::abs(shells[b].volume); });
  // Larger shells first, so that everything that can enclose a shell is oriented before it.
  std::vector<int> wanted(shells.size(), 1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Shell& inner = shells[order[i]];
    for (std::size_t j = i; j-- > 0;) {  // the smallest enclosing shell is the one that counts
      Shell& outer = shells[order[j]];
      if (!encloses(mesh, outer, inner)) continue;
      if (inner.given() * outer.given() < 0) wanted[order[i]] = -wanted[order[j]];
      break;
    }
  }
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if ((shells[s].volume < 0 ? -1 : 1) == wanted[s]) continue;
    for (const std::int32_t t : shells[s].triangles) {
      flip(mesh, t);
      flipped[t] = static_cast<char>(flipped[t] == 0);
    }
  }
  report.rim = rim_of(mesh);
  report.flipped = std::count(flipped.begin(), flipped.end(), 1);
  return report;
}

}  // namespace pliant
