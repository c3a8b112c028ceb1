#include "geometry/defects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "geometry/disjoint_sets.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

struct Edge {
  std::int32_t low, high;
  std::int32_t triangle;
  bool forward;  // the triangle runs from low to high
  [[nodiscard]] bool same(const Edge& other) const { return low == other.low && high == other.high; }
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      const std::int32_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::array{x.low, x.high, x.triangle} < std::array{y.low, y.high, y.triangle};
  });
  return edges;
}

// work(first, last) for the edges of each pair of vertices.
template <class Work>
void for_pairs(const std::vector<Edge>& edges, Work&& work) {
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].same(edges[i])) ++end;
    work(i, end);
  }
}

Hole hole_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& loop) {
  Hole hole;
  hole.edges = static_cast<std::int64_t>(loop.size());
  for (const std::int32_t v : loop) {
    hole.centre = vec::add(hole.centre, vec::mul(mesh.vertices[v], 1 / static_cast<double>(loop.size())));
  }
  const Vec3d& origin = mesh.vertices[0];  // as in signed_volume
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3d &a = mesh.vertices[loop[i]], &b = mesh.vertices[loop[(i + 1) % loop.size()]];
    hole.area += vec::norm(vec::cross(vec::sub(a, hole.centre), vec::sub(b, hole.centre))) / 2;
    hole.volume += vec::dot(vec::sub(hole.centre, origin), vec::cross(vec::sub(a, origin), vec::sub(b, origin))) / 6;
  }
  return hole;
}

std::vector<std::vector<Hole>> holes_by_shell(const TriangleMesh& mesh, const OrientationReport& orientation) {
  std::vector<TriangleMesh> part(orientation.shells);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) part[orientation.shell[t]].triangles.push_back(mesh.triangles[t]);
  std::vector<std::vector<Hole>> out;
  for (TriangleMesh& shell : part) {
    // Its vertices alone: there may be as many shells as triangles.
    std::map<std::int32_t, std::int32_t> number;
    for (auto& t : shell.triangles) {
      for (std::int32_t& v : t) {
        const auto [at, added] = number.try_emplace(v, static_cast<std::int32_t>(shell.vertices.size()));
        if (added) shell.vertices.push_back(mesh.vertices[v]);
        v = at->second;
      }
    }
    out.push_back(holes_of(shell));
  }
  return out;
}

}  // namespace

double area_of(const TriangleMesh& mesh, std::int64_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const auto& v = mesh.vertices;
  return vec::norm(vec::cross(vec::sub(v[b], v[a]), vec::sub(v[c], v[a]))) / 2;
}

Vec3d centroid_of(const TriangleMesh& mesh, std::int64_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return vec::mul(vec::add(vec::add(mesh.vertices[a], mesh.vertices[b]), mesh.vertices[c]), 1.0 / 3);
}

TriangleMesh without(const TriangleMesh& mesh, const std::vector<char>& drop) {
  TriangleMesh out;
  out.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (drop.empty() || drop[t] == 0) out.triangles.push_back(mesh.triangles[t]);
  }
  return out;
}

// The rim is a sum of directed loops: at every vertex as many of its edges arrive as leave. A walk along them is cut wherever
// it meets itself, so that each loop is simple.
std::vector<Hole> holes_of(const TriangleMesh& mesh) {
  const std::vector<Edge> edges = sorted_edges(mesh);
  std::map<std::int32_t, std::vector<std::int32_t>> next;  // against the triangles: as those that would close the hole
  for_pairs(edges, [&](std::size_t first, std::size_t last) {
    int balance = 0;
    for (std::size_t i = first; i < last; ++i) balance += edges[i].forward ? 1 : -1;
    for (; balance > 0; --balance) next[edges[first].high].push_back(edges[first].low);
    for (; balance < 0; ++balance) next[edges[first].low].push_back(edges[first].high);
  });
  std::vector<Hole> holes;
  std::vector<std::int32_t> path, loop;
  std::map<std::int32_t, std::size_t> place;  // of a vertex in the path
  while (!next.empty()) {
    path.assign(1, next.begin()->first);
    place = {{path[0], 0}};
    while (!path.empty()) {
      const auto out = next.find(path.back());
      if (out == next.end()) break;
      const std::int32_t to = out->second.back();
      out->second.pop_back();
      if (out->second.empty()) next.erase(out);
      const auto [at, added] = place.try_emplace(to, path.size());
      if (added) {
        path.push_back(to);
        continue;
      }
      loop.assign(path.begin() + static_cast<std::ptrdiff_t>(at->second), path.end());
      holes.push_back(hole_of(mesh, loop));
      for (std::size_t i = 1; i < loop.size(); ++i) place.erase(loop[i]);
      path.resize(at->second + 1);
    }
  }
  std::stable_sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) { return a.area > b.area; });
  return holes;
}

Copies copies_of(const TriangleMesh& mesh) {
  Copies out;
  struct Key {
    std::array<std::int32_t, 3> v;
    std::int32_t triangle;
  };
  std::vector<Key> keys;
  keys.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    keys.push_back({mesh.triangles[t], static_cast<std::int32_t>(t)});
    std::sort(keys.back().v.begin(), keys.back().v.end());
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& x, const Key& y) { return x.v != y.v ? x.v < y.v : x.triangle < y.triangle; });
  std::vector<char> copy(mesh.triangles.size(), 0);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].v != keys[i - 1].v) continue;
    copy[keys[i].triangle] = 1;
    ++out.found;
    out.first = out.first < 0 ? keys[i].triangle : std::min(out.first, keys[i].triangle);
  }
  if (out.found == 0) return out;
  // Connected copies are evaluated together: how many odd edges they would repair, and how many they would create.
  const std::vector<Edge> edges = sorted_edges(mesh);
  DisjointSets sets(mesh.triangles.size());
  for_pairs(edges, [&](std::size_t first, std::size_t last) {
    std::int32_t before = -1;
    for (std::size_t i = first; i < last; ++i) {
      if (copy[edges[i].triangle] == 0) continue;
      if (before >= 0) sets.join(before, edges[i].triangle);
      before = edges[i].triangle;
    }
  });
  std::vector<std::int64_t> gain(mesh.triangles.size(), 0);
  for_pairs(edges, [&](std::size_t first, std::size_t last) {
    std::size_t copies = 0;
    std::int32_t set = -1;
    for (std::size_t i = first; i < last; ++i) {
      if (copy[edges[i].triangle] == 0) continue;
      ++copies;
      set = sets.find(edges[i].triangle);
    }
    if (copies % 2 != 0) gain[set] += (last - first) % 2 != 0 ? 1 : -1;
  });
  out.drop.assign(mesh.triangles.size(), 0);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    if (copy[t] == 0 || gain[sets.find(static_cast<std::int32_t>(t))] < 0) continue;
    out.drop[t] = 1;
    ++out.dropped;
    out.first = static_cast<std::int32_t>(t);
  }
  if (out.dropped == 0) out.drop.clear();
  return out;
}

std::vector<char> sheets_of(const TriangleMesh& mesh, const OrientationReport& orientation) {
  const std::vector<std::vector<Hole>> holes = holes_by_shell(mesh, orientation);
  std::vector<double> area(holes.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area[orientation.shell[t]] += area_of(mesh, static_cast<std::int64_t>(t));
  // Per edge: its shells, with how many of their triangles, odd numbers only; small shells first.
  const std::vector<Edge> edges = sorted_edges(mesh);
  std::vector<std::vector<std::size_t>> rim(holes.size());  // shell -> numbers of the edges that it has an odd number of times
  std::vector<char> odd;
  for_pairs(edges, [&](std::size_t first, std::size_t last) {
    std::map<std::int32_t, int> times;
    for (std::size_t i = first; i < last; ++i) ++times[orientation.shell[edges[i].triangle]];
    for (const auto& [shell, n] : times) {
      if (n % 2 != 0) rim[shell].push_back(odd.size());
    }
    odd.push_back(static_cast<char>((last - first) % 2));
  });
  std::vector<std::size_t> order(holes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return area[a] < area[b]; });
  std::vector<char> sheet(holes.size(), 0);
  for (const std::size_t s : order) {
    double open = 0;
    for (const Hole& hole : holes[s]) open += hole.area;
    if (!(open > kLargestHole * area[s])) continue;
    const auto mends =
        static_cast<std::size_t>(std::count_if(rim[s].begin(), rim[s].end(), [&](auto e) { return odd[e] != 0; }));
    if (2 * mends < rim[s].size()) continue;
    sheet[s] = 1;
    for (const std::size_t e : rim[s]) odd[e] = static_cast<char>(odd[e] == 0);
  }
  if (std::find(sheet.begin(), sheet.end(), 1) == sheet.end()) return {};
  std::vector<char> out;
  for (const std::int32_t s : orientation.shell) out.push_back(sheet[s]);
  return out;
}

}  // namespace pliant
