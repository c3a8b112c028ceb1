// The overlay of a closed surface with the cut surface of all completely cut cells: which triangle is crossed where, the pieces
// that triangles fall into, and the caps that close the cut. Only combinatorial decisions, all exact, say what belongs
// together; coordinates are rounded once, at the end. Every edge of the result is therefore used twice, once in each direction.
//
// A vertex of the result is an original vertex, an original edge x a cut face, an original triangle x a cut edge, or a point of
// the cut surface inside the body; all but the first come once per *sector*, the material between neighbouring cut faces around
// it. At the front of a cut its sides meet; a side of a triangle with both ends there would be used by both sides of the cut,
// so it gets a middle, which comes once per sector again. A cut face has two sides: 2 f for its back, 2 f + 1 for its front.
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "cutting/surface/cell_interface.h"
#include "cutting/surface/surface_source.h"

namespace pliant::overlay {

/// Identity of a vertex of the result: (kind, source, sector).
struct VertexKey {
  /// The last four are middles of sides: of an edge of the cut surface, of a segment, of a side between two triangles of a
  /// cap or of a piece.
  enum Kind : std::int64_t { edge_face, triangle_edge, point, edge_middle, segment_middle, cap_middle, piece_middle };
  static std::int64_t of(Kind kind, std::int64_t what) { return what << 3 | kind; }
  std::int64_t a = 0, b = 0;
  friend bool operator==(const VertexKey&, const VertexKey&) = default;
};
struct VertexKeyHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t h = static_cast<std::uint64_t>(key.a) * 0x9e3779b97f4a7c15U ^ static_cast<std::uint64_t>(key.b);
    h ^= h >> 29;
    h *= 0xbf58476d1ce4e5b9U;
    return h ^ h >> 32;
  }
};

struct CutVertex {
  VertexKey key{};
  Vec3d x{};
  Carrier carrier{};
};

/// Triangles that replace an original triangle or close a cut face; corners are original vertices (>= 0) or ~index into
/// `vertices`.
struct Patch {
  std::vector<CutVertex> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

class Overlay {
 public:
  Overlay(TriangleMesh mesh, const CutGrid& grid) : source_(std::move(mesh), grid) {}
  [[nodiscard]] const SurfaceSource& source() const { return source_; }

  /// Replaces the cut surface inside these cells (removes it for those with one component). Afterwards dirty_triangles and
  /// dirty_faces list what must be recomputed.
  void update(const std::vector<CutGridCell>& cells);

  [[nodiscard]] const std::vector<std::int32_t>& dirty_triangles() const { return dirty_triangles_; }
  /// Cut faces, including removed ones.
  [[nodiscard]] const std::vector<std::int32_t>& dirty_faces() const { return dirty_faces_; }
  /// Original vertices whose carrier changed; also filled by pieces_of for vertices next to the cut.
  std::unordered_map<std::int32_t, Carrier> moved_vertices;

  /// The pieces of an original triangle; empty if it is whole.
  [[nodiscard]] Patch pieces_of(std::int32_t triangle);
  /// Both caps of a cut face, the back's first; empty if it is gone or outside the body.
  [[nodiscard]] Patch caps_of(std::int32_t face) const;
  [[nodiscard]] bool is_cut(std::int32_t triangle) const { return triangle_faces_.contains(triangle); }
  /// Whether an original vertex lies in a cell that is or was cut.
  [[nodiscard]] bool holds(std::int32_t vertex) const { return vertex_cell_.contains(vertex); }

 private:
  struct Point {
    ExactPoint exact{};
    Vec3d x{};
    int winding = 0;
    bool has_winding = false, dirty = false;
    std::vector<std::int32_t> faces;
    std::vector<std::array<std::int32_t, 2>> root;  ///< {side of a face, lowest side of its sector}
  };
  struct Hit {
    std::int32_t triangle = 0;
    int sign = 0;  ///< 1: leaves the body on the way from p to q
    Vec3d x{};
  };
  /// An edge of the cut surface.
  struct Edge {
    std::int32_t p = 0, q = 0;
    std::vector<std::int32_t> faces;  ///< counter-clockwise around the direction from p to q
    std::vector<Hit> hits;            ///< from p to q
    bool sorted = false;
  };
  /// One end of the segment in which a triangle crosses a face.
  struct End {
    bool inner = false;    ///< true: an original edge crosses the face; false: the triangle crosses an edge of the face
    std::int32_t ref = 0;  ///< the original edge, or the edge of the cut surface
  };
  struct Segment {
    std::int32_t triangle = 0;
    End start{},
        end{};  ///< the body lies to its left, seen from the face's front; the front to its left, seen from outside the body
  };
  struct CapNode {
    int kind = 0;           ///< as VertexKey::Kind
    std::int32_t ref = 0;   ///< original edge, edge of the cut surface, or point
    std::int32_t with = 0;  ///< triangle, or level of a point
    Vec3d x{};
  };
  struct Face {
    std::array<std::int32_t, 3> p{}, edge{};
    std::array<bool, 3> forward{};
    std::int64_t cell = -1;            ///< -1: gone
    std::array<Carrier, 2> carrier{};  ///< of its back and of its front
    bool air = false;
    std::vector<std::array<std::int32_t, 2>> crossed;  ///< {original edge, sign as in EdgeCut}
    std::vector<Segment> segments;
    std::vector<CapNode> nodes;
    std::vector<std::array<std::int32_t, 3>> cap;  ///< over nodes
  };
  struct EdgeCut {
    std::int32_t face = 0;
    int sign = 0;  ///< 1: from the face's back to its front on the way along the original edge
  };
  struct CellState {
    CutGridCell cell;
    CellInterface shape;
    std::vector<std::int32_t> faces;
  };
  struct Graph;

  std::int32_t find_point(const InterfacePoint& p);
  std::int32_t find_edge(std::int32_t p, std::int32_t q);
  std::int32_t find_face(const std::array<std::int32_t, 3>& p);
  void remove_faces(CellState& state);
  void add_faces(CellState& state, std::int64_t number);
  void find_hits(Edge& edge, const GridIndex& cell);
  void cross_edges(const std::vector<std::int32_t>& faces, const GridIndex& cell);
  void make_segments(std::int32_t face);
  void make_cap(std::int32_t face);
  void mark(std::int32_t point);
  void collect_dirty();
  void locate_vertices(const CellState& state);
  void sort_around(Edge& edge) const;
  void find_sectors(std::int32_t point);
  [[nodiscard]] std::array<ExactPoint, 3> corners(const Face& face) const {
    return {points_[face.p[0]].exact, points_[face.p[1]].exact, points_[face.p[2]].exact};
  }
  [[nodiscard]] std::array<ExactPoint, 3> corners_of(std::int32_t triangle) const {
    const auto& t = source_.mesh().triangles[triangle];
    return {source_.exact(t[0]), source_.exact(t[1]), source_.exact(t[2])};
  }
  int winding(std::int32_t point, const GridIndex& cell);
  /// Side of the neighbour across the sector that a face's side bounds at an edge.
  [[nodiscard]] std::int32_t across(const Edge& edge, std::int32_t side) const;
  [[nodiscard]] Vec3d cut_position(std::int32_t source_edge, std::int32_t face) const;
  /// Whether a place on an edge of a face is the same vertex on both sides of the face.
  [[nodiscard]] bool merged_at(std::int32_t edge, std::int32_t face) const;
  /// Whether two sectors of an edge have the same vertices at both of its ends.
  [[nodiscard]] bool pinched(const Edge& edge) const;
  [[nodiscard]] std::int32_t root_of(std::int32_t point, std::int32_t side) const;
  void split_sides(std::int32_t face, Patch& patch) const;
  void split_doubled_sides(std::int32_t triangle, Patch& patch) const;
  [[nodiscard]] Carrier carrier_of(std::int32_t side) const;
  [[nodiscard]] bool in_air(std::int32_t side) const;
  [[nodiscard]] CutVertex vertex_on_face(std::int32_t source_edge, std::int32_t side) const;
  [[nodiscard]] CutVertex vertex_on_edge(std::int32_t triangle, std::int32_t edge, std::int32_t side) const;
  [[nodiscard]] CutVertex vertex_at(std::int32_t point, std::int32_t level, std::int32_t side) const;
  void sort_cuts(std::int32_t source_edge);

  SurfaceSource source_;
  std::vector<Point> points_;
  std::vector<Edge> edges_;
  std::vector<Face> faces_;
  std::unordered_map<std::int64_t, std::int32_t> point_of_;
  std::unordered_map<std::uint64_t, std::int32_t> edge_of_;
  std::unordered_map<VertexKey, std::int32_t, VertexKeyHash> face_of_;
  std::unordered_map<std::int64_t, CellState> cells_;
  std::unordered_map<std::int32_t, std::vector<EdgeCut>> edge_cuts_;            ///< by original edge
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> triangle_faces_;  ///< by original triangle: faces it crosses
  std::unordered_map<std::int32_t, std::int64_t> vertex_cell_;                  ///< cut cell that holds an original vertex
  std::vector<std::int32_t> dirty_points_, dirty_faces_, dirty_triangles_;
  std::vector<std::int32_t> sorted_faces_, side_root_;  ///< of find_sectors
  std::unordered_set<std::int32_t> dirty_edges_;        ///< original edges whose cuts have to be sorted
};

}  // namespace pliant::overlay
