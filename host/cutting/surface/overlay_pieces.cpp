// Pieces of original triangles: the faces of the graph that its border and its segments with the cut faces make.
#include <algorithm>
#include <optional>

#include "cutting/surface/overlay.h"
#include "geometry/disjoint_sets.h"
#include "geometry/polygon.h"
#include "pliant/error.h"

namespace pliant::overlay {

// Nodes are the corners of the triangle, then the cuts of its edges, then the places where edges of the cut surface cross it.
// Each piece lies to the left of its half-edges. Half-edges of the border have no twin; segment s has 2 s + border (start to
// end, its left is the face's front) and the next one.
struct Overlay::Graph {
  struct Node {
    int kind = -1;          // -1: corner, else as VertexKey::Kind
    std::int32_t ref = 0;   // original vertex, original edge, or edge of the cut surface
    std::int32_t face = 0;  // of an edge_face node
    int lines = 0;
    std::int32_t border = -1;                      // half-edge that leaves it along the border
    std::vector<std::array<std::int32_t, 2>> out;  // {face, half-edge}: segments that leave it
  };
  struct Half {
    std::int32_t from = 0, to = 0;
    std::int32_t side = -1;  // of the cut face to its left, -1: border
  };
  std::vector<Node> nodes;
  std::vector<Half> halves;
  std::int32_t border = 0;

  std::int32_t find(int kind, std::int32_t ref, std::int32_t face) {
    for (std::size_t i = 3; i < nodes.size(); ++i) {
      if (nodes[i].kind == kind && nodes[i].ref == ref && nodes[i].face == face) return static_cast<std::int32_t>(i);
    }
    nodes.push_back({kind, ref, face, 0, -1, {}});
    return static_cast<std::int32_t>(nodes.size() - 1);
  }
};

Patch Overlay::pieces_of(std::int32_t triangle) {
  Patch patch;
  const auto found = triangle_faces_.find(triangle);
  if (found == triangle_faces_.end()) return patch;
  const auto& corner = source_.mesh().triangles[triangle];
  const auto& x = source_.mesh().vertices;
  Graph graph;
  for (int i = 0; i < 3; ++i) graph.nodes.push_back({-1, corner[i], 0, 1 << i | 1 << (i + 2) % 3, -1, {}});
  const auto leave = [&](std::int32_t from, std::int32_t to) {
    graph.nodes[from].border = static_cast<std::int32_t>(graph.halves.size());
    graph.halves.push_back({from, to, -1});
  };
  for (std::int32_t i = 0; i < 3; ++i) {
    const std::int32_t e = source_.edges_of(triangle)[i];
    std::int32_t last = i;
    if (const auto cuts = edge_cuts_.find(e); cuts != edge_cuts_.end()) {
      std::vector<std::int32_t> faces;
      for (const EdgeCut& cut : cuts->second) faces.push_back(cut.face);
      if (source_.edges()[e].face[0] != triangle) std::reverse(faces.begin(), faces.end());
      for (const std::int32_t f : faces) {
        const std::int32_t node = graph.find(VertexKey::edge_face, e, f);
        graph.nodes[node].lines = 1 << i;
        leave(last, node);
        last = node;
      }
    }
    leave(last, (i + 1) % 3);
  }
  graph.border = static_cast<std::int32_t>(graph.halves.size());
  for (const std::int32_t f : found->second) {
    const auto& segments = faces_[f].segments;
    const auto s = std::lower_bound(segments.begin(), segments.end(), triangle,
                                    [](const Segment& segment, std::int32_t t) { return segment.triangle < t; });
    const auto node = [&](const End& end) {
      return graph.find(end.inner ? VertexKey::edge_face : VertexKey::triangle_edge, end.ref, end.inner ? f : 0);
    };
    const std::int32_t start = node(s->start), end = node(s->end);
    const auto join = [&](std::int32_t from, std::int32_t to) {
      graph.nodes[from].out.push_back({f, static_cast<std::int32_t>(graph.halves.size())});
      graph.halves.push_back({from, to, 2 * f + 1});
      graph.nodes[to].out.push_back({f, static_cast<std::int32_t>(graph.halves.size())});
      graph.halves.push_back({to, from, 2 * f});
    };
    if (!s->start.inner && !s->end.inner && merged_at(s->start.ref, f) && merged_at(s->end.ref, f)) {
      const std::int32_t middle = graph.find(VertexKey::segment_middle, f, 0);
      join(start, middle);
      join(middle, end);
    } else {
      join(start, end);
    }
  }

  // The half-edge that follows around the piece.
  const auto follow = [&](std::int32_t h) -> std::int32_t {
    const Graph::Half& half = graph.halves[h];
    const Graph::Node& node = graph.nodes[half.to];
    if (half.side < 0) return node.out.empty() ? node.border : node.out.front()[1];
    if (node.kind == VertexKey::segment_middle) {  // two segments leave it, to either side
      const std::int32_t out = node.out[0][1];
      return graph.halves[out].side == half.side ? out : node.out[1][1];
    }
    if (node.kind != VertexKey::triangle_edge) return node.border;
    const Edge& edge = edges_[node.ref];
    const std::int32_t next = across(edge, half.side) / 2;
    for (const auto& [face, out] : node.out) {
      if (face == next) return out;
    }
    throw Error(ErrorCode::internal, "a cut edge crosses a triangle that one of its faces misses");
  };
  const auto middle_of = [&](std::int32_t f, std::int32_t t) {
    Vec3d sum{};
    for (const std::int32_t e : faces_[f].edge) {
      for (const Hit& hit : edges_[e].hits) {
        if (hit.triangle == t) sum = vec::add(sum, hit.x);
      }
    }
    return vec::mul(sum, 0.5);
  };
  const auto vertex = [&](std::int32_t h, std::int32_t after) {
    const Graph::Node& node = graph.nodes[graph.halves[h].to];
    const std::int32_t side = std::max(graph.halves[h].side, graph.halves[after].side);
    if (node.kind == VertexKey::edge_face) {
      CutVertex v = vertex_on_face(node.ref, side);
      v.x = cut_position(node.ref, node.face);
      return v;
    }
    if (node.kind == VertexKey::segment_middle) {
      return CutVertex{
          {VertexKey::of(VertexKey::segment_middle, triangle), side}, middle_of(node.ref, triangle), carrier_of(side)};
    }
    CutVertex v = vertex_on_edge(triangle, node.ref, graph.halves[h].side);
    for (const Hit& hit : edges_[node.ref].hits) {
      if (hit.triangle == triangle) v.x = hit.x;
    }
    return v;
  };

  const Vec3d &a = x[corner[0]], &b = x[corner[1]], &c = x[corner[2]];
  const Vec3d normal = vec::cross(vec::sub(b, a), vec::sub(c, a));
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);

  std::vector<FlatPoint> flat;
  std::vector<std::int32_t> id;  // of each corner of each loop: original vertex, or ~index into the patch
  std::vector<Loop> loops;
  DisjointSets sets(graph.nodes.size());
  for (const Graph::Half& half : graph.halves) sets.join(half.from, half.to);
  std::vector<char> seen(graph.halves.size(), 0);
  for (std::size_t first = 0; first < graph.halves.size(); ++first) {
    if (seen[first] != 0) continue;
    Loop loop;
    for (auto h = static_cast<std::int32_t>(first); seen[h] == 0;) {
      seen[h] = 1;
      const std::int32_t after = follow(h);
      const Graph::Node& node = graph.nodes[graph.halves[h].to];
      Vec3d place = a;
      if (node.kind < 0) {
        id.push_back(node.ref);
        place = x[node.ref];
        for (const std::int32_t end : {graph.halves[h].from, graph.halves[after].to}) {
          // A vertex next to a cut of its own cell lies on that cut's side, whatever its position says.
          const Graph::Node& cut = graph.nodes[end];
          if (cut.kind != VertexKey::edge_face) continue;
          const auto cell = vertex_cell_.find(node.ref);
          if (cell == vertex_cell_.end() || cell->second != faces_[cut.face].cell) continue;
          const std::int32_t side =
              graph.halves[cut.out.front()[1]].side;  // to the left when leaving the border: before the cut
          moved_vertices[node.ref] = carrier_of(end == graph.halves[h].from ? side ^ 1 : side);
        }
      } else {
        patch.vertices.push_back(vertex(h, after));
        place = patch.vertices.back().x;
        id.push_back(~static_cast<std::int32_t>(patch.vertices.size() - 1));
      }
      loop.corners.push_back(static_cast<std::int32_t>(flat.size()));
      flat.push_back({place[u] - a[u], place[v] - a[v], static_cast<std::uint8_t>(node.lines)});
      h = after;
    }
    loop.group = sets.find(graph.halves[first].from);
    loops.push_back(std::move(loop));
  }
  // A connected set inside the triangle, away from its border, has one loop around it: a hole of the piece that contains it.
  std::unordered_map<std::int32_t, std::size_t> outermost;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].group == sets.find(0)) continue;
    const auto [entry, is_new] = outermost.try_emplace(loops[i].group, i);
    if (!is_new && loop_area(flat, loops[i].corners) < loop_area(flat, loops[entry->second].corners)) entry->second = i;
  }
  for (const auto& [node, loop] : outermost) loops[loop].hole = true;
  patch.triangles = triangulate(flat, std::move(loops));
  for (auto& t : patch.triangles) t = {id[t[0]], id[t[1]], id[t[2]]};
  split_doubled_sides(triangle, patch);
  return patch;
}

// A vertex where both sides of a cut meet comes several times around a piece. Inner sides that join the same two vertices
// again, or a vertex to itself, get middles: every edge of the result is used once in each direction.
void Overlay::split_doubled_sides(std::int32_t triangle, Patch& patch) const {
  using Side = std::pair<std::int32_t, std::int32_t>;
  const auto& x = source_.mesh().vertices;
  const auto insert = [&](const Side& half, std::int32_t middle) {
    for (std::size_t t = patch.triangles.size(); t-- > 0;) {
      const std::array<std::int32_t, 3> old = patch.triangles[t];
      for (int i = 0; i < 3; ++i) {
        if (old[i] != half.first || old[(i + 1) % 3] != half.second) continue;
        patch.triangles[t] = {old[i], middle, old[(i + 2) % 3]};
        patch.triangles.push_back({middle, old[(i + 1) % 3], old[(i + 2) % 3]});
        return;
      }
    }
  };
  const auto split = [&](const Side& side) {
    const auto [u, w] = side;
    const auto place = [&](std::int32_t v) { return v >= 0 ? x[v] : patch.vertices[~v].x; };
    const Carrier carrier = patch.vertices[~std::min(u, w)].carrier;  // one of them is no corner of the triangle
    const auto number = static_cast<std::int64_t>(patch.vertices.size());
    const std::int32_t middle = ~static_cast<std::int32_t>(number);
    patch.vertices.push_back({{VertexKey::of(VertexKey::piece_middle, triangle), number},
                              u == w ? place(u) : vec::mul(vec::add(place(u), place(w)), 0.5),
                              carrier});
    insert({u, w}, middle);
    insert({w, u}, middle);
  };
  // Loops first: afterwards no triangle has a vertex twice. A loop that is split once is a doubled side.
  std::vector<Side> sides;
  const auto next = [&]() -> std::optional<Side> {
    sides.clear();
    for (const auto& t : patch.triangles) {
      for (int i = 0; i < 3; ++i) sides.emplace_back(t[i], t[(i + 1) % 3]);
    }
    std::sort(sides.begin(), sides.end());
    for (const Side& side : sides) {
      if (side.first == side.second) return side;
    }
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (sides[i] == sides[i - 1] && std::binary_search(sides.begin(), sides.end(), Side{sides[i].second, sides[i].first})) {
        return sides[i];
      }
    }
    return {};
  };
  for (std::optional<Side> side = next(); side; side = next()) split(*side);
}

}  // namespace pliant::overlay
