#include "geometry/orient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
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

std::vector<HalfEdge> sorted_edges(const TriangleMesh& mesh) {
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

// Neighbours over edges that exactly two triangles share.
std::vector<std::array<Link, 3>> neighbours(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_edges(mesh);
  std::vector<std::array<Link, 3>> links(mesh.triangles.size());
  std::vector<int> used(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) {
      const HalfEdge &x = edges[i], &y = edges[i + 1];
      links[x.triangle][used[x.triangle]++] = {y.triangle, x.forward == y.forward};
      links[y.triangle][used[y.triangle]++] = {x.triangle, x.forward == y.forward};
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
  const std::vector<HalfEdge> edges = sorted_edges(mesh);
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
  // Larger shells first: when a shell is looked at, everything that can enclose it has been turned.
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
