#include "cutting/surface/overlay_caps.h"

#include <algorithm>
#include <cstdlib>

#include "geometry/polygon.h"
#include "pliant/error.h"

namespace pliant::overlay {
namespace {

/// Outlines the part of a face inside the body. The outline follows the border of the face where it runs inside the body and
/// the segments elsewhere. On each side of the face places where the body begins and ends are matched like brackets, so a
/// surface that overlaps itself gives overlapping caps that are closed all the same.
class CapOutline {
 public:
  CapOutline(CutFaces& faces, const SurfaceCrossings& crossings, std::int32_t face)
      : faces_(faces), crossings_(crossings), number_(face), face_(faces.face(face)) {}

  /// Follows the border of the face, from a corner around which the surface winds `level` times.
  void follow_border(int level) {
    for (int i = 0; i < 3; ++i) level = follow_side(i, level);
  }

  void follow_segments() {
    for (const Segment& s : face_.segments) {
      const std::int32_t start = end_node(s.start, s.triangle), end = end_node(s.end, s.triangle);
      next_[start] = end;
    }
  }

  void triangulate_inside() {
    const Vec3d &a = corner_position(0), &b = corner_position(1), &c = corner_position(2);
    const FlatAxes axes(vec::cross(vec::sub(b, a), vec::sub(c, a)));
    std::vector<FlatPoint> flat;
    for (std::size_t i = 0; i < face_.nodes.size(); ++i) flat.push_back(axes.project(face_.nodes[i].x, a, lines_[i]));
    std::vector<Loop> loops = outlines();
    for (Loop& loop : loops) loop.hole = loops.size() > 1 && loop_area(flat, loop.corners) <= 0;
    face_.cap = triangulate(flat, std::move(loops));
  }

 private:
  /// Returns the level at the end of side i. `level`: that at its start.
  int follow_side(int i, int level) {
    const FaceEdge& edge = faces_.edge(face_.edge[i]);
    std::vector<std::int32_t> open;  // begun inside, or (level below 0) begun outside
    for (int k = 1; k <= std::abs(level); ++k) open.push_back(corner(i, level > 0 ? k : -k));
    for (std::size_t h = 0; h < edge.hits.size(); ++h) {
      const Hit& hit = edge.hits[face_.forward[i] ? h : edge.hits.size() - 1 - h];
      const std::int32_t node = find_node({VertexKey::triangle_edge, face_.edge[i], hit.triangle, hit.x}, 1 << i);
      const int step = (hit.sign > 0) == face_.forward[i] ? -1 : 1;
      if (level * step >= 0) {
        open.push_back(node);
      } else {
        (step < 0 ? next_[open.back()] : next_[node]) = step < 0 ? node : open.back();
        open.pop_back();
      }
      level += step;
    }
    const int j = (i + 1) % 3;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto depth = static_cast<int>(k) + 1;
      const std::int32_t node = corner(j, level > 0 ? depth : -depth);
      (level > 0 ? next_[open[k]] : next_[node]) = level > 0 ? node : open[k];
    }
    faces_.point(face_.p[j]).winding = level;
    faces_.point(face_.p[j]).has_winding = true;
    return level;
  }

  std::int32_t find_node(const CapNode& node, int line) {
    for (std::size_t i = 0; i < face_.nodes.size(); ++i) {
      const CapNode& n = face_.nodes[i];
      if (n.kind == node.kind && n.ref == node.ref && n.with == node.with) return static_cast<std::int32_t>(i);
    }
    face_.nodes.push_back(node);
    next_.push_back(-1);
    lines_.push_back(line);
    return static_cast<std::int32_t>(face_.nodes.size() - 1);
  }
  [[nodiscard]] const Vec3d& corner_position(int i) const { return faces_.point(face_.p[i]).x; }
  std::int32_t corner(int i, int level) {
    return find_node({VertexKey::point, face_.p[i], level, corner_position(i)}, 1 << i | 1 << (i + 2) % 3);
  }
  std::int32_t end_node(const SegmentEnd& end, std::int32_t triangle) {
    if (end.inner) return find_node({VertexKey::edge_face, end.ref, 0, crossings_.cut_position(end.ref, number_)}, 0);
    return find_node({VertexKey::triangle_edge, end.ref, triangle, {}}, 0);
  }

  [[nodiscard]] std::vector<Loop> outlines() const {
    std::vector<Loop> loops;
    std::vector<char> seen(next_.size(), 0);
    for (std::size_t i = 0; i < next_.size(); ++i) {
      if (seen[i] != 0) continue;
      Loop loop;
      for (auto n = static_cast<std::int32_t>(i); seen[n] == 0; n = next_[n]) {
        if (next_[n] < 0) throw Error(ErrorCode::internal, "the outline of a cut face is open");
        seen[n] = 1;
        loop.corners.push_back(n);
      }
      loops.push_back(std::move(loop));
    }
    return loops;
  }

  CutFaces& faces_;
  const SurfaceCrossings& crossings_;
  const std::int32_t number_;
  CutFace& face_;
  std::vector<std::int32_t> next_;  ///< by node: the next one of the outline
  std::vector<int> lines_;          ///< by node: sides of the face that it lies on
};

/// Returns how often the body's surface winds around the first corner of a face: along a side from a corner where that is
/// known, else from the corner of its cell.
int winding_at_start(SurfaceSource& source, CutFaces& faces, const CutFace& face, const GridIndex& cell) {
  FacePoint& point = faces.point(face.p[0]);
  for (int i = 0; i < 3 && !point.has_winding; i += 2) {
    const FacePoint& known = faces.point(face.p[i == 0 ? 1 : 2]);
    if (!known.has_winding) continue;
    const bool arrives = face.forward[i] == (i == 2);  // the edge leads to the first corner
    int level = known.winding;
    for (const Hit& hit : faces.edge(face.edge[i]).hits) level += arrives ? -hit.sign : hit.sign;
    point.winding = level;
    point.has_winding = true;
  }
  if (!point.has_winding) {
    const ExactPoint corner = source.exact_corner(cell);
    point.winding = source.winding(cell);
    for (const std::int32_t t : source.triangles_at(cell)) point.winding -= source.crossing(corner, point.exact, t);
    point.has_winding = true;
  }
  return point.winding;
}

/// Gives middles to the sides of cap triangles that more than two triangles of the result would use.
class CapSides {
 public:
  /// `patch` has the vertices of the back's cap, then those of the front's.
  CapSides(const CutFaces& faces, const Sectors& sectors, std::int32_t face, Patch& patch)
      : faces_(faces),
        sectors_(sectors),
        number_(face),
        face_(faces.face(face)),
        patch_(patch),
        count_(static_cast<std::int32_t>(face_.nodes.size())) {}

  void add_triangles() {
    for (const auto& t : face_.cap) add_triangle(t, {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])});
  }

 private:
  struct Middle {
    std::array<std::int32_t, 2> ends{};
    std::int32_t vertex = -1;  // in the patch: of the back, the front's follows; -1: none
  };

  [[nodiscard]] bool merged(std::int32_t n) const { return patch_.vertices[n].key == patch_.vertices[n + count_].key; }

  /// Returns the edge of the face that has both points as its ends, -1 if none has.
  [[nodiscard]] std::int32_t face_edge(const CapNode& m, const CapNode& n) const {
    if (m.kind != VertexKey::point || n.kind != VertexKey::point || m.with != n.with) return -1;
    for (const std::int32_t e : face_.edge) {
      if (std::min(m.ref, n.ref) == faces_.edge(e).p && std::max(m.ref, n.ref) == faces_.edge(e).q) return e;
    }
    return -1;
  }

  /// Returns true if both nodes lie on one side of the face.
  [[nodiscard]] bool on_border(const CapNode& m, const CapNode& n) const {
    for (int i = 0; i < 3; ++i) {
      const auto on = [&](const CapNode& x) {
        return x.kind == VertexKey::triangle_edge ? x.ref == face_.edge[i]
                                                  : x.ref == face_.p[i] || x.ref == face_.p[(i + 1) % 3];
      };
      if (on(m) && on(n)) return true;
    }
    return false;
  }

  [[nodiscard]] bool is_end(const SegmentEnd& end, std::int32_t triangle, std::int32_t n) const {
    const CapNode& node = face_.nodes[n];
    return node.ref == end.ref &&
           (end.inner ? node.kind == VertexKey::edge_face : node.kind == VertexKey::triangle_edge && node.with == triangle);
  }

  /// Identity of the middle of a side, without its sector; empty: the side needs none.
  [[nodiscard]] VertexKey key_of(std::int32_t a, std::int32_t b) const {
    const CapNode &m = face_.nodes[a], &n = face_.nodes[b];
    if (const std::int32_t e = face_edge(m, n); e >= 0) {
      if (!sectors_.pinched(faces_.edge(e))) return {};
      return {VertexKey::of(VertexKey::edge_middle, e), m.with + 128};
    }
    if (!merged(a) || !merged(b)) return {};
    if (on_border(m, n)) return {};  // part of a side of the face, which is used once per sector
    for (const Segment& s : face_.segments) {
      if ((is_end(s.start, s.triangle, a) && is_end(s.end, s.triangle, b)) ||
          (is_end(s.start, s.triangle, b) && is_end(s.end, s.triangle, a))) {
        return {VertexKey::of(VertexKey::segment_middle, s.triangle), 0};
      }
    }
    return {VertexKey::of(VertexKey::cap_middle, number_), static_cast<std::int64_t>(a) << 32 | b};
  }

  /// Returns the middle of a side as a vertex of the patch, -1 if it needs none.
  std::int32_t middle(std::int32_t a, std::int32_t b) {
    if (a > b) std::swap(a, b);
    for (const Middle& m : middles_) {
      if (m.ends == std::array{a, b}) return m.vertex;
    }
    middles_.push_back({{a, b}, -1});
    const VertexKey key = key_of(a, b);
    if (key == VertexKey{}) return -1;
    const Vec3d x = vec::mul(vec::add(face_.nodes[a].x, face_.nodes[b].x), 0.5);
    for (std::int32_t side = 2 * number_; side <= 2 * number_ + 1; ++side) patch_.vertices.push_back(on_side(key, x, side));
    return middles_.back().vertex = static_cast<std::int32_t>(patch_.vertices.size()) - 2;
  }

  [[nodiscard]] CutVertex on_side(const VertexKey& key, const Vec3d& x, std::int32_t side) const {
    const auto kind = static_cast<VertexKey::Kind>(key.a & 7);
    if (kind == VertexKey::edge_middle) {
      const CutVertex at = sectors_.vertex_on_edge(0, static_cast<std::int32_t>(key.a >> 3), side);
      return {{key.a, (at.key.b & 0xffffffff) << 8 | key.b}, x, at.carrier};
    }
    const std::int64_t sector = kind == VertexKey::segment_middle ? side : key.b << 1 | (side & 1);
    return {{key.a, sector}, x, sectors_.carrier_of(side)};
  }

  /// A triangle of the back and its mirror image of the front.
  void emit(std::int32_t a, std::int32_t b, std::int32_t c) {
    const auto front = [&](std::int32_t n) { return ~(n < count_ ? n + count_ : n + 1); };
    patch_.triangles.push_back({~a, ~b, ~c});
    patch_.triangles.push_back({front(a), front(c), front(b)});
  }

  void add_triangle(const std::array<std::int32_t, 3>& t, const std::array<std::int32_t, 3>& m) {
    std::vector<std::int32_t> ring;  // corners and middles
    for (int i = 0; i < 3; ++i) {
      ring.push_back(t[i]);
      if (m[i] >= 0) ring.push_back(m[i]);
    }
    if (ring.size() == 6) {
      emit(m[0], m[1], m[2]);
      for (int i = 0; i < 3; ++i) emit(t[i], m[i], m[(i + 2) % 3]);
      return;
    }
    int first = 0;  // a place from which a fan has no flat triangle
    while (first < 3 && m[first] < 0) ++first;
    const auto size = static_cast<int>(ring.size());
    const int start = first == 3 ? 0 : static_cast<int>(std::find(ring.begin(), ring.end(), m[first]) - ring.begin());
    for (int i = 1; i + 1 < size; ++i) emit(ring[start], ring[(start + i) % size], ring[(start + i + 1) % size]);
  }

  const CutFaces& faces_;
  const Sectors& sectors_;
  const std::int32_t number_;
  const CutFace& face_;
  Patch& patch_;
  const std::int32_t count_;
  std::vector<Middle> middles_;
};

}  // namespace

void make_cap(SurfaceSource& source, CutFaces& faces, const SurfaceCrossings& crossings, std::int32_t face,
              const GridIndex& cell) {
  CapOutline outline(faces, crossings, face);
  outline.follow_border(winding_at_start(source, faces, faces.face(face), cell));
  outline.follow_segments();
  outline.triangulate_inside();
}

Patch caps_of(const CutFaces& faces, const Sectors& sectors, std::int32_t f) {
  Patch patch;
  const CutFace& face = faces.face(f);
  if (face.cell < 0) return patch;
  for (std::int32_t side = 2 * f; side <= 2 * f + 1; ++side) {
    for (const CapNode& node : face.nodes) {
      patch.vertices.push_back(node.kind == VertexKey::point           ? sectors.vertex_at(node.ref, node.with, side)
                               : node.kind == VertexKey::triangle_edge ? sectors.vertex_on_edge(node.with, node.ref, side)
                                                                       : sectors.vertex_on_face(node.ref, side));
      patch.vertices.back().x = node.x;
    }
  }
  CapSides(faces, sectors, f, patch).add_triangles();
  return patch;
}

}  // namespace pliant::overlay
