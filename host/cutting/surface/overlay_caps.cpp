// Caps: the part of each cut face that lies inside the body.
#include <algorithm>

#include "cutting/surface/overlay.h"
#include "geometry/polygon.h"
#include "pliant/error.h"

namespace pliant::overlay {
namespace {

// Project along the axis that the normal is closest to, keeping the sense of rotation.
struct Projection {
  int u = 0, v = 1;
  explicit Projection(const Vec3d& normal) {
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (std::abs(normal[a]) > std::abs(normal[axis])) axis = a;
    }
    u = (axis + 1) % 3;
    v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
  }
  [[nodiscard]] FlatPoint operator()(const Vec3d& x, const Vec3d& base, int lines) const {
    return {x[u] - base[u], x[v] - base[v], static_cast<std::uint8_t>(lines)};
  }
};

}  // namespace

// The outline follows the border of the face where it runs inside the body and the segments elsewhere. On each side of the face
// places where the body begins and ends are matched like brackets, so a surface that overlaps itself gives overlapping caps
// that are closed all the same.
void Overlay::make_cap(std::int32_t f) {
  Face& face = faces_[f];
  const GridIndex cell = cells_[face.cell].cell.index;
  std::vector<std::int32_t> next;
  std::vector<int> lines;
  const auto add = [&](const CapNode& node, int line) {
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      const CapNode& n = face.nodes[i];
      if (n.kind == node.kind && n.ref == node.ref && n.with == node.with) return static_cast<std::int32_t>(i);
    }
    face.nodes.push_back(node);
    next.push_back(-1);
    lines.push_back(line);
    return static_cast<std::int32_t>(face.nodes.size() - 1);
  };
  const auto corner = [&](int i, int level) {
    return add({VertexKey::point, face.p[i], level, points_[face.p[i]].x}, 1 << i | 1 << (i + 2) % 3);
  };
  for (int i = 0; i < 3 && !points_[face.p[0]].has_winding; i += 2) {  // along a side from a corner where it is known
    const Point& known = points_[face.p[i == 0 ? 1 : 2]];
    if (!known.has_winding) continue;
    const bool arrives = face.forward[i] == (i == 2);  // the edge leads to the first corner
    int level = known.winding;
    for (const Hit& hit : edges_[face.edge[i]].hits) level += arrives ? -hit.sign : hit.sign;
    points_[face.p[0]].winding = level;
    points_[face.p[0]].has_winding = true;
  }
  int level = winding(face.p[0], cell);
  for (int i = 0; i < 3; ++i) {
    const Edge& edge = edges_[face.edge[i]];
    std::vector<std::int32_t> open;  // begun inside, or (level below 0) begun outside
    for (int k = 1; k <= std::abs(level); ++k) open.push_back(corner(i, level > 0 ? k : -k));
    for (std::size_t h = 0; h < edge.hits.size(); ++h) {
      const Hit& hit = edge.hits[face.forward[i] ? h : edge.hits.size() - 1 - h];
      const std::int32_t node = add({VertexKey::triangle_edge, face.edge[i], hit.triangle, hit.x}, 1 << i);
      const int step = (hit.sign > 0) == face.forward[i] ? -1 : 1;
      if (level * step >= 0) {
        open.push_back(node);
      } else {
        (step < 0 ? next[open.back()] : next[node]) = step < 0 ? node : open.back();
        open.pop_back();
      }
      level += step;
    }
    const int j = (i + 1) % 3;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto depth = static_cast<int>(k) + 1;
      const std::int32_t node = corner(j, level > 0 ? depth : -depth);
      (level > 0 ? next[open[k]] : next[node]) = level > 0 ? node : open[k];
    }
    points_[face.p[j]].winding = level;
    points_[face.p[j]].has_winding = true;
  }
  const auto end_node = [&](const End& end, std::int32_t triangle) {
    if (end.inner) return add({VertexKey::edge_face, end.ref, 0, cut_position(end.ref, f)}, 0);
    return add({VertexKey::triangle_edge, end.ref, triangle, {}}, 0);
  };
  for (const Segment& s : face.segments) {
    const std::int32_t start = end_node(s.start, s.triangle), end = end_node(s.end, s.triangle);
    next[start] = end;
  }
  const Vec3d &a = points_[face.p[0]].x, &b = points_[face.p[1]].x, &c = points_[face.p[2]].x;
  const Projection project(vec::cross(vec::sub(b, a), vec::sub(c, a)));
  std::vector<FlatPoint> flat;
  for (std::size_t i = 0; i < face.nodes.size(); ++i) flat.push_back(project(face.nodes[i].x, a, lines[i]));
  std::vector<Loop> loops;
  std::vector<char> seen(next.size(), 0);
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (seen[i] != 0) continue;
    Loop loop;
    for (auto n = static_cast<std::int32_t>(i); seen[n] == 0; n = next[n]) {
      if (next[n] < 0) throw Error(ErrorCode::internal, "the outline of a cut face is open");
      seen[n] = 1;
      loop.corners.push_back(n);
    }
    loop.hole = loop_area(flat, loop.corners) <= 0;
    loops.push_back(std::move(loop));
  }
  if (loops.size() == 1) loops[0].hole = false;
  face.cap = triangulate(flat, std::move(loops));
}

std::int32_t Overlay::root_of(std::int32_t p, std::int32_t side) const {
  const auto& root = points_[p].root;
  return (*std::lower_bound(root.begin(), root.end(), std::array{side, -1}))[1];
}

bool Overlay::merged_at(std::int32_t e, std::int32_t f) const {
  const Edge& edge = edges_[e];
  return std::min(2 * f, across(edge, 2 * f)) == std::min(2 * f + 1, across(edge, 2 * f + 1));
}

bool Overlay::pinched(const Edge& edge) const {
  if (edge.faces.size() < 2) return false;
  std::vector<std::array<std::int32_t, 2>> ends;  // of each sector
  for (const std::int32_t f : edge.faces) {
    for (std::int32_t side = 2 * f; side <= 2 * f + 1; ++side) {
      if (side < across(edge, side)) ends.push_back({root_of(edge.p, side), root_of(edge.q, side)});
    }
  }
  std::sort(ends.begin(), ends.end());
  return std::adjacent_find(ends.begin(), ends.end()) != ends.end();
}

// Give middles to the sides of cap triangles that would otherwise be used more than twice.
void Overlay::split_sides(std::int32_t f, Patch& patch) const {
  const Face& face = faces_[f];
  const auto count = static_cast<std::int32_t>(face.nodes.size());
  const auto merged = [&](std::int32_t n) { return patch.vertices[n].key == patch.vertices[n + count].key; };
  const auto node_of = [&](const End& end, std::int32_t triangle, std::int32_t n) {
    const CapNode& node = face.nodes[n];
    return node.ref == end.ref &&
           (end.inner ? node.kind == VertexKey::edge_face : node.kind == VertexKey::triangle_edge && node.with == triangle);
  };
  struct Middle {
    std::array<std::int32_t, 2> ends{};
    std::int32_t vertex = -1;  // in the patch: of the back, the front's follows; -1: none
  };
  std::vector<Middle> middles;
  const auto key_of = [&](std::int32_t a, std::int32_t b) -> VertexKey {
    const CapNode &m = face.nodes[a], &n = face.nodes[b];
    if (m.kind == VertexKey::point && n.kind == VertexKey::point && m.with == n.with) {  // a side of the face?
      for (const std::int32_t e : face.edge) {
        const Edge& edge = edges_[e];
        if (std::min(m.ref, n.ref) != edge.p || std::max(m.ref, n.ref) != edge.q) continue;
        if (!pinched(edge)) return {};
        return {VertexKey::of(VertexKey::edge_middle, e), m.with + 128};
      }
    }
    if (!merged(a) || !merged(b)) return {};
    for (int i = 0; i < 3; ++i) {  // part of a side of the face, which is used once per sector
      const auto on = [&](const CapNode& x) {
        return x.kind == VertexKey::triangle_edge ? x.ref == face.edge[i] : x.ref == face.p[i] || x.ref == face.p[(i + 1) % 3];
      };
      if (on(m) && on(n)) return {};
    }
    for (const Segment& s : face.segments) {
      if ((node_of(s.start, s.triangle, a) && node_of(s.end, s.triangle, b)) ||
          (node_of(s.start, s.triangle, b) && node_of(s.end, s.triangle, a))) {
        return {VertexKey::of(VertexKey::segment_middle, s.triangle), 0};
      }
    }
    return {VertexKey::of(VertexKey::cap_middle, f), static_cast<std::int64_t>(a) << 32 | b};
  };
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    if (a > b) std::swap(a, b);
    for (const Middle& m : middles) {
      if (m.ends == std::array{a, b}) return m.vertex;
    }
    middles.push_back({{a, b}, -1});
    VertexKey key = key_of(a, b);
    if (key == VertexKey{}) return -1;
    const Vec3d x = vec::mul(vec::add(face.nodes[a].x, face.nodes[b].x), 0.5);
    const auto kind = static_cast<VertexKey::Kind>(key.a & 7);
    for (std::int32_t side = 2 * f; side <= 2 * f + 1; ++side) {
      CutVertex v{key, x, carrier_of(side)};
      if (kind == VertexKey::edge_middle) {
        const auto e = static_cast<std::int32_t>(key.a >> 3);
        const CutVertex at = vertex_on_edge(0, e, side);
        v = {{key.a, (at.key.b & 0xffffffff) << 8 | key.b}, x, at.carrier};
      } else {
        v.key.b = key.b << 1 | (side & 1);
        if (kind == VertexKey::segment_middle) v.key.b = side;
      }
      patch.vertices.push_back(v);
    }
    return middles.back().vertex = static_cast<std::int32_t>(patch.vertices.size()) - 2;
  };
  for (const auto& t : face.cap) {
    const std::array<std::int32_t, 3> m{middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
    std::vector<std::int32_t> ring;  // corners and middles
    int first = 0;                   // a place from which a fan has no flat triangle
    for (int i = 0; i < 3; ++i) {
      ring.push_back(t[i]);
      if (m[i] >= 0) ring.push_back(m[i]);
    }
    const auto emit = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      const auto front = [&](std::int32_t n) { return ~(n < count ? n + count : n + 1); };
      patch.triangles.push_back({~a, ~b, ~c});
      patch.triangles.push_back({front(a), front(c), front(b)});
    };
    if (ring.size() == 6) {
      emit(m[0], m[1], m[2]);
      for (int i = 0; i < 3; ++i) emit(t[i], m[i], m[(i + 2) % 3]);
      continue;
    }
    while (first < 3 && m[first] < 0) ++first;
    const auto size = static_cast<int>(ring.size());
    const int start = first == 3 ? 0 : static_cast<int>(std::find(ring.begin(), ring.end(), m[first]) - ring.begin());
    for (int i = 1; i + 1 < size; ++i) emit(ring[start], ring[(start + i) % size], ring[(start + i + 1) % size]);
  }
}

Patch Overlay::caps_of(std::int32_t f) const {
  Patch patch;
  const Face& face = faces_[f];
  if (face.cell < 0) return patch;
  for (std::int32_t side = 2 * f; side <= 2 * f + 1; ++side) {
    for (const CapNode& node : face.nodes) {
      patch.vertices.push_back(node.kind == VertexKey::point           ? vertex_at(node.ref, node.with, side)
                               : node.kind == VertexKey::triangle_edge ? vertex_on_edge(node.with, node.ref, side)
                                                                       : vertex_on_face(node.ref, side));
      patch.vertices.back().x = node.x;
    }
  }
  split_sides(f, patch);
  return patch;
}

Carrier Overlay::carrier_of(std::int32_t side) const { return faces_[side / 2].carrier[side % 2]; }

bool Overlay::in_air(std::int32_t side) const { return faces_[side / 2].air; }

CutVertex Overlay::vertex_on_face(std::int32_t source_edge, std::int32_t side) const {
  return {{VertexKey::of(VertexKey::edge_face, source_edge), side}, {}, carrier_of(side)};
}

CutVertex Overlay::vertex_on_edge(std::int32_t triangle, std::int32_t e, std::int32_t side) const {
  const std::int32_t other = across(edges_[e], side);
  const std::int32_t low = std::min(side, other), high = std::max(side, other);
  return {{VertexKey::of(VertexKey::triangle_edge, triangle), static_cast<std::int64_t>(e) << 32 | low},
          {},
          carrier_of(in_air(low) && !in_air(high) ? high : low)};
}

CutVertex Overlay::vertex_at(std::int32_t p, std::int32_t level, std::int32_t side) const {
  const auto& root = points_[p].root;
  const std::int32_t lowest = root_of(p, side);
  std::int32_t best = lowest;
  for (const auto& [member, its_root] : root) {
    if (its_root == lowest && in_air(best) && !in_air(member)) best = member;
  }
  return {{VertexKey::of(VertexKey::point, p), static_cast<std::int64_t>(lowest) << 32 | (level + 128)}, {}, carrier_of(best)};
}

}  // namespace pliant::overlay
