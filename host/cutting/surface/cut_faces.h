// The cut surface of all completely cut cells as a mesh of triangles: its points, edges and faces, each found by its
// corners, so that neighbouring cells share them. A face has two sides: 2 f is the back of face f, 2 f + 1 its front.
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cutting/surface/cut_vertex.h"
#include "cutting/surface/surface_source.h"

namespace pliant::overlay {

struct FacePoint {
  ExactPoint exact{};
  Vec3d x{};
  int winding = 0;  ///< how often the body's surface winds around it; computed on demand (overlay_caps.cpp)
  bool has_winding = false, dirty = false;
  std::vector<std::int32_t> faces;
  std::vector<std::array<std::int32_t, 2>> root;  ///< {side of a face, lowest side of its sector} (cut_sectors.h)
};

/// A place where an edge of the cut surface crosses a triangle of the body's surface.
struct Hit {
  std::int32_t triangle = 0;
  int sign = 0;  ///< 1: leaves the body on the way from p to q
  Vec3d x{};
};

struct FaceEdge {
  std::int32_t p = 0, q = 0;
  std::vector<std::int32_t> faces;  ///< counter-clockwise around the direction from p to q, once `sorted`
  std::vector<Hit> hits;            ///< from p to q
  bool sorted = false;
};

/// One end of the segment in which a triangle crosses a face.
struct SegmentEnd {
  bool inner = false;    ///< true: an original edge crosses the face; false: the triangle crosses an edge of the face
  std::int32_t ref = 0;  ///< the original edge, or the edge of the cut surface
};

/// The segment in which a triangle of the body's surface crosses a face.
struct Segment {
  std::int32_t triangle = 0;
  SegmentEnd start{},
      end{};  ///< the body lies to its left, seen from the face's front; the front to its left, seen from outside the body
};

/// A corner of a cap.
struct CapNode {
  int kind = 0;           ///< as VertexKey::Kind
  std::int32_t ref = 0;   ///< original edge, edge of the cut surface, or point
  std::int32_t with = 0;  ///< triangle, or level of a point
  Vec3d x{};
};

struct CutFace {
  std::array<std::int32_t, 3> p{}, edge{};
  std::array<bool, 3> forward{};     ///< edge i leads from corner i to the next
  std::int64_t cell = -1;            ///< -1: gone
  std::array<Carrier, 2> carrier{};  ///< of its back and of its front
  bool air = false;
  std::vector<std::array<std::int32_t, 2>> crossed;  ///< {original edge, sign as in EdgeCut}
  std::vector<Segment> segments;
  std::vector<CapNode> nodes;
  std::vector<std::array<std::int32_t, 3>> cap;  ///< over nodes
};

class CutFaces {
 public:
  explicit CutFaces(const ExactFrame& frame) : frame_(frame) {}

  [[nodiscard]] const FacePoint& point(std::int32_t p) const { return points_[p]; }
  [[nodiscard]] const FaceEdge& edge(std::int32_t e) const { return edges_[e]; }
  [[nodiscard]] const CutFace& face(std::int32_t f) const { return faces_[f]; }
  FacePoint& point(std::int32_t p) { return points_[p]; }
  FaceEdge& edge(std::int32_t e) { return edges_[e]; }
  CutFace& face(std::int32_t f) { return faces_[f]; }
  [[nodiscard]] std::array<ExactPoint, 3> corners(std::int32_t f) const {
    const CutFace& face = faces_[f];
    return {points_[face.p[0]].exact, points_[face.p[1]].exact, points_[face.p[2]].exact};
  }

  /// Returns the number of a point, the same for all cells that share it.
  std::int32_t find_point(const InterfacePoint& p);
  /// Adds a face with these corners to a cell, and marks its corners. Its edges have to be sorted again.
  std::int32_t add(const std::array<std::int32_t, 3>& corners, std::int64_t cell, const std::array<Carrier, 2>& carrier,
                   bool air);
  /// Removes a face, and marks its corners.
  void remove(std::int32_t f);
  /// Returns the points whose faces have changed since the last call, ascending.
  std::vector<std::int32_t> take_marked();

 private:
  std::int32_t find_edge(std::int32_t p, std::int32_t q);
  std::int32_t find_face(const std::array<std::int32_t, 3>& p);
  void mark(std::int32_t point);

  const ExactFrame& frame_;
  std::vector<FacePoint> points_;
  std::vector<FaceEdge> edges_;
  std::vector<CutFace> faces_;
  std::unordered_map<std::int64_t, std::int32_t> point_of_;
  std::unordered_map<std::uint64_t, std::int32_t> edge_of_;
  std::unordered_map<VertexKey, std::int32_t, VertexKeyHash> face_of_;
  std::vector<std::int32_t> marked_;
};

}  // namespace pliant::overlay
