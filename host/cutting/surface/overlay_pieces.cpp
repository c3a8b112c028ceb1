// A triangle's border and its segments with the cut faces are a graph; the pieces are the areas between its edges.
#include "cutting/surface/overlay_pieces.h"

#include <algorithm>
#include <optional>

#include "geometry/disjoint_sets.h"
#include "geometry/polygon.h"
#include "pliant/error.h"

namespace pliant::overlay {
namespace {

// Nodes are the corners of the triangle, then the cuts of its edges, then the places where edges of the cut surface cross it.
// Each piece lies to the left of its half-edges. Half-edges of the border have no twin; segment s has 2 s + border (start to
// end, its left is the face's front) and the next one.
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

class PieceGraph {
 public:
  PieceGraph(const PieceSource& source, std::int32_t triangle, const std::vector<std::int32_t>& faces)
      : source_(source), triangle_(triangle) {
    add_border();
    for (const std::int32_t f : faces) add_segment(f);
  }

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<Half>& halves() const { return halves_; }

  /// Returns the half-edge that follows around the piece.
  [[nodiscard]] std::int32_t follow(std::int32_t h) const {
    const Half& half = halves_[h];
    const Node& node = nodes_[half.to];
    if (half.side < 0) return node.out.empty() ? node.border : node.out.front()[1];
    if (node.kind == VertexKey::segment_middle) {  // two segments leave it, to either side
      const std::int32_t out = node.out[0][1];
      return halves_[out].side == half.side ? out : node.out[1][1];
    }
    if (node.kind != VertexKey::triangle_edge) return node.border;
    const std::int32_t next = source_.sectors.across(source_.faces.edge(node.ref), half.side) / 2;
    for (const auto& [face, out] : node.out) {
      if (face == next) return out;
    }
    throw Error(ErrorCode::internal, "a cut edge crosses a triangle that one of its faces misses");
  }

  /// Returns the vertex of the result at the end of half-edge h of a piece, which `after` follows; no corner.
  [[nodiscard]] CutVertex vertex(std::int32_t h, std::int32_t after) const {
    const Node& node = nodes_[halves_[h].to];
    const std::int32_t side = std::max(halves_[h].side, halves_[after].side);
    if (node.kind == VertexKey::edge_face) {
      CutVertex v = source_.sectors.vertex_on_face(node.ref, side);
      v.x = source_.crossings.cut_position(node.ref, node.face);
      return v;
    }
    if (node.kind == VertexKey::segment_middle) {
      return {{VertexKey::of(VertexKey::segment_middle, triangle_), side},
              segment_middle(node.ref),
              source_.sectors.carrier_of(side)};
    }
    CutVertex v = source_.sectors.vertex_on_edge(triangle_, node.ref, halves_[h].side);
    for (const Hit& hit : source_.faces.edge(node.ref).hits) {
      if (hit.triangle == triangle_) v.x = hit.x;
    }
    return v;
  }

 private:
  std::int32_t find(int kind, std::int32_t ref, std::int32_t face) {
    for (std::size_t i = 3; i < nodes_.size(); ++i) {
      if (nodes_[i].kind == kind && nodes_[i].ref == ref && nodes_[i].face == face) return static_cast<std::int32_t>(i);
    }
    nodes_.push_back({kind, ref, face, 0, -1, {}});
    return static_cast<std::int32_t>(nodes_.size() - 1);
  }

  void add_border() {
    const auto& corner = source_.surface.mesh().triangles[triangle_];
    for (int i = 0; i < 3; ++i) nodes_.push_back({-1, corner[i], 0, 1 << i | 1 << (i + 2) % 3, -1, {}});
    const auto leave = [&](std::int32_t from, std::int32_t to) {
      nodes_[from].border = static_cast<std::int32_t>(halves_.size());
      halves_.push_back({from, to, -1});
    };
    for (std::int32_t i = 0; i < 3; ++i) {
      const std::int32_t e = source_.surface.edges_of(triangle_)[i];
      std::int32_t last = i;
      if (const std::vector<EdgeCut>* cuts = source_.crossings.cuts_of(e); cuts != nullptr) {
        std::vector<std::int32_t> faces;
        for (const EdgeCut& cut : *cuts) faces.push_back(cut.face);
        if (source_.surface.edges()[e].face[0] != triangle_) std::reverse(faces.begin(), faces.end());
        for (const std::int32_t f : faces) {
          const std::int32_t node = find(VertexKey::edge_face, e, f);
          nodes_[node].lines = 1 << i;
          leave(last, node);
          last = node;
        }
      }
      leave(last, (i + 1) % 3);
    }
  }

  void add_segment(std::int32_t f) {
    const auto& segments = source_.faces.face(f).segments;
    const auto s = std::lower_bound(segments.begin(), segments.end(), triangle_,
                                    [](const Segment& segment, std::int32_t t) { return segment.triangle < t; });
    const auto node = [&](const SegmentEnd& end) {
      return find(end.inner ? VertexKey::edge_face : VertexKey::triangle_edge, end.ref, end.inner ? f : 0);
    };
    const std::int32_t start = node(s->start), end = node(s->end);
    const auto join = [&](std::int32_t from, std::int32_t to) {
      nodes_[from].out.push_back({f, static_cast<std::int32_t>(halves_.size())});
      halves_.push_back({from, to, 2 * f + 1});
      nodes_[to].out.push_back({f, static_cast<std::int32_t>(halves_.size())});
      halves_.push_back({to, from, 2 * f});
    };
    if (!s->start.inner && !s->end.inner && source_.sectors.merged_at(s->start.ref, f) &&
        source_.sectors.merged_at(s->end.ref, f)) {
      const std::int32_t middle = find(VertexKey::segment_middle, f, 0);
      join(start, middle);
      join(middle, end);
    } else {
      join(start, end);
    }
  }

  /// Position of the middle of the triangle's segment with a face [m].
  [[nodiscard]] Vec3d segment_middle(std::int32_t f) const {
    Vec3d sum{};
    for (const std::int32_t e : source_.faces.face(f).edge) {
      for (const Hit& hit : source_.faces.edge(e).hits) {
        if (hit.triangle == triangle_) sum = vec::add(sum, hit.x);
      }
    }
    return vec::mul(sum, 0.5);
  }

  const PieceSource& source_;
  const std::int32_t triangle_;
  std::vector<Node> nodes_;
  std::vector<Half> halves_;
};

/// Walks around the pieces of a graph and triangulates them.
class PieceLoops {
 public:
  PieceLoops(const PieceSource& source, const PieceGraph& graph, const std::array<std::int32_t, 3>& corner,
             std::unordered_map<std::int32_t, Carrier>& moved)
      : source_(source), graph_(graph), moved_(moved), base_(position(corner[0])), axes_(normal_of(corner)) {}

  Patch triangulated() {
    const std::vector<Half>& halves = graph_.halves();
    DisjointSets sets(graph_.nodes().size());
    for (const Half& half : halves) sets.join(half.from, half.to);
    seen_.assign(halves.size(), 0);
    for (std::size_t first = 0; first < halves.size(); ++first) {
      if (seen_[first] != 0) continue;
      Loop loop = walk(static_cast<std::int32_t>(first));
      loop.group = sets.find(halves[first].from);
      loops_.push_back(std::move(loop));
    }
    find_holes(sets.find(0));
    patch_.triangles = triangulate(flat_, std::move(loops_));
    for (auto& t : patch_.triangles) t = {id_[t[0]], id_[t[1]], id_[t[2]]};
    return std::move(patch_);
  }

 private:
  [[nodiscard]] const Vec3d& position(std::int32_t vertex) const { return source_.surface.mesh().vertices[vertex]; }
  [[nodiscard]] Vec3d normal_of(const std::array<std::int32_t, 3>& corner) const {
    const Vec3d &a = position(corner[0]), &b = position(corner[1]), &c = position(corner[2]);
    return vec::cross(vec::sub(b, a), vec::sub(c, a));
  }

  Loop walk(std::int32_t first) {
    Loop loop;
    for (std::int32_t h = first; seen_[h] == 0;) {
      seen_[h] = 1;
      const std::int32_t after = graph_.follow(h);
      const Node& node = graph_.nodes()[graph_.halves()[h].to];
      Vec3d place{};
      if (node.kind < 0) {
        id_.push_back(node.ref);
        place = position(node.ref);
        carry_corner(h, after);
      } else {
        patch_.vertices.push_back(graph_.vertex(h, after));
        place = patch_.vertices.back().x;
        id_.push_back(~static_cast<std::int32_t>(patch_.vertices.size() - 1));
      }
      loop.corners.push_back(static_cast<std::int32_t>(flat_.size()));
      flat_.push_back(axes_.project(place, base_, node.lines));
      h = after;
    }
    return loop;
  }

  /// A vertex next to a cut of its own cell lies on that cut's side, whatever its position says.
  void carry_corner(std::int32_t h, std::int32_t after) {
    const std::int32_t vertex = graph_.nodes()[graph_.halves()[h].to].ref;
    for (const std::int32_t end : {graph_.halves()[h].from, graph_.halves()[after].to}) {
      const Node& cut = graph_.nodes()[end];
      if (cut.kind != VertexKey::edge_face) continue;
      const auto cell = source_.vertex_cell.find(vertex);
      if (cell == source_.vertex_cell.end() || cell->second != source_.faces.face(cut.face).cell) continue;
      const std::int32_t side =
          graph_.halves()[cut.out.front()[1]].side;  // to the left when leaving the border: before the cut
      moved_[vertex] = source_.sectors.carrier_of(end == graph_.halves()[h].from ? side ^ 1 : side);
    }
  }

  /// A connected set inside the triangle, away from its border, has one loop around it: a hole of the piece that contains it.
  void find_holes(std::int32_t border) {
    std::unordered_map<std::int32_t, std::size_t> outermost;
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      if (loops_[i].group == border) continue;
      const auto [entry, is_new] = outermost.try_emplace(loops_[i].group, i);
      if (!is_new && loop_area(flat_, loops_[i].corners) < loop_area(flat_, loops_[entry->second].corners)) entry->second = i;
    }
    for (const auto& [group, loop] : outermost) loops_[loop].hole = true;
  }

  const PieceSource& source_;
  const PieceGraph& graph_;
  std::unordered_map<std::int32_t, Carrier>& moved_;
  const Vec3d base_;
  const FlatAxes axes_;
  Patch patch_;
  std::vector<char> seen_;
  std::vector<FlatPoint> flat_;
  std::vector<std::int32_t> id_;  ///< of each corner of each loop: original vertex, or ~index into the patch
  std::vector<Loop> loops_;
};

/// Splits sides that a piece uses twice. A vertex where both sides of a cut meet comes several times around a piece. Inner
/// sides that join the same two vertices again, or a vertex to itself, get middles: every edge of the result is used once in
/// each direction.
class DoubledSides {
 public:
  DoubledSides(const SurfaceSource& surface, std::int32_t triangle, Patch& patch)
      : surface_(surface), triangle_(triangle), patch_(patch) {}

  void split_all() {
    for (std::optional<Side> side = next(); side; side = next()) split(*side);
  }

 private:
  using Side = std::pair<std::int32_t, std::int32_t>;

  /// Loops first: afterwards no triangle has a vertex twice. A loop that is split once is a doubled side.
  std::optional<Side> next() {
    sides_.clear();
    for (const auto& t : patch_.triangles) {
      for (int i = 0; i < 3; ++i) sides_.emplace_back(t[i], t[(i + 1) % 3]);
    }
    std::sort(sides_.begin(), sides_.end());
    for (const Side& side : sides_) {
      if (side.first == side.second) return side;
    }
    for (std::size_t i = 1; i < sides_.size(); ++i) {
      if (sides_[i] == sides_[i - 1] &&
          std::binary_search(sides_.begin(), sides_.end(), Side{sides_[i].second, sides_[i].first})) {
        return sides_[i];
      }
    }
    return {};
  }

  void split(const Side& side) {
    const auto [u, w] = side;
    const auto place = [this](std::int32_t v) { return v >= 0 ? surface_.mesh().vertices[v] : patch_.vertices[~v].x; };
    const Carrier carrier = patch_.vertices[~std::min(u, w)].carrier;  // one of them is no corner of the triangle
    const auto number = static_cast<std::int64_t>(patch_.vertices.size());
    const std::int32_t middle = ~static_cast<std::int32_t>(number);
    patch_.vertices.push_back({{VertexKey::of(VertexKey::piece_middle, triangle_), number},
                               u == w ? place(u) : vec::mul(vec::add(place(u), place(w)), 0.5),
                               carrier});
    insert({u, w}, middle);
    insert({w, u}, middle);
  }

  void insert(const Side& half, std::int32_t middle) {
    for (std::size_t t = patch_.triangles.size(); t-- > 0;) {
      const std::array<std::int32_t, 3> old = patch_.triangles[t];
      for (int i = 0; i < 3; ++i) {
        if (old[i] != half.first || old[(i + 1) % 3] != half.second) continue;
        patch_.triangles[t] = {old[i], middle, old[(i + 2) % 3]};
        patch_.triangles.push_back({middle, old[(i + 1) % 3], old[(i + 2) % 3]});
        return;
      }
    }
  }

  const SurfaceSource& surface_;
  const std::int32_t triangle_;
  Patch& patch_;
  std::vector<Side> sides_;
};

}  // namespace

Patch pieces_of(const PieceSource& source, std::int32_t triangle, std::unordered_map<std::int32_t, Carrier>& moved) {
  const std::vector<std::int32_t>* faces = source.crossings.faces_across(triangle);
  if (faces == nullptr) return {};
  const PieceGraph graph(source, triangle, *faces);
  Patch patch = PieceLoops(source, graph, source.surface.mesh().triangles[triangle], moved).triangulated();
  DoubledSides(source.surface, triangle, patch).split_all();
  return patch;
}

}  // namespace pliant::overlay
