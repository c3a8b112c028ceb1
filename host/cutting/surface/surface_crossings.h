// Where the body's surface and the cut surface cross: edges of one with faces of the other, and the segments between these
// places in which a triangle crosses a face. Predicates are exact; positions are rounded once.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "cutting/surface/cut_faces.h"
#include "geometry/vec.h"

namespace pliant::overlay {

/// A face that crosses an original edge.
struct EdgeCut {
  std::int32_t face = 0;
  int sign = 0;  ///< 1: from the face's back to its front on the way along the original edge
};

class SurfaceCrossings {
 public:
  SurfaceCrossings(const SurfaceSource& source, CutFaces& faces) : source_(source), faces_(faces) {}

  /// Crosses a new face's edges with the triangles of its cell; edges that other faces already have are known.
  void cross_face_edges(std::int32_t face, const GridIndex& cell);
  /// Crosses the original edges in a cell with its faces.
  void cross_source_edges(const std::vector<std::int32_t>& faces, const GridIndex& cell);
  /// Joins the crossings of a face to segments, ascending by triangle.
  void make_segments(std::int32_t face);
  /// Removes the crossings of a face with original edges and triangles.
  void remove(std::int32_t face);
  /// Sorts the cuts of the original edges that got new ones.
  void sort_changed();

  /// Faces that a triangle crosses; nullptr: it is whole.
  [[nodiscard]] const std::vector<std::int32_t>* faces_across(std::int32_t triangle) const;
  /// Returns the cuts of an original edge from its start to its end; nullptr: none.
  [[nodiscard]] const std::vector<EdgeCut>* cuts_of(std::int32_t source_edge) const;
  /// Where an original edge crosses a face [m].
  [[nodiscard]] Vec3d cut_position(std::int32_t source_edge, std::int32_t face) const;

 private:
  void find_hits(FaceEdge& edge, const GridIndex& cell) const;
  void sort_cuts(std::int32_t source_edge);

  const SurfaceSource& source_;
  CutFaces& faces_;
  std::unordered_map<std::int32_t, std::vector<EdgeCut>> edge_cuts_;            ///< by original edge
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> triangle_faces_;  ///< by original triangle
  std::unordered_set<std::int32_t> changed_edges_;                              ///< original edges with new cuts
};

/// Bounds of points that snapping to the exact grid may move out of it.
template <class... Points>
vec::Box box_of(double margin, const Points&... points) {
  vec::Box box;
  (box.extend(points), ...);
  for (int a = 0; a < 3; ++a) {
    box.lower[a] -= margin;
    box.upper[a] += margin;
  }
  return box;
}

inline constexpr double kSnapMargin = 1e-6;  ///< share of the spacing; more than snapping moves a point

}  // namespace pliant::overlay
