// Sectors: the material between neighbouring cut faces around an edge or a point of the cut surface. A place on the cut surface
// gives the result one vertex per sector around it, and at the front of a cut, where its sides meet, a single one.
#pragma once
#include <cstdint>
#include <vector>

#include "cutting/surface/cut_faces.h"

namespace pliant::overlay {

class Sectors {
 public:
  explicit Sectors(CutFaces& faces) : faces_(faces) {}

  /// Sorts the faces around the edges of a face whose edges have changed.
  void sort_edges_of(std::int32_t face);
  /// Groups the sides of the faces around a point into sectors. The edges there are sorted.
  void find_around(std::int32_t point);

  /// Returns the side across the sector that a face's side bounds at an edge.
  [[nodiscard]] std::int32_t across(const FaceEdge& edge, std::int32_t side) const;
  /// Returns true if a place on an edge of a face is the same vertex on both sides of the face.
  [[nodiscard]] bool merged_at(std::int32_t edge, std::int32_t face) const;
  /// Returns true if two sectors of an edge have the same vertices at both of its ends.
  [[nodiscard]] bool pinched(const FaceEdge& edge) const;

  /// The component that the material at a side of a face belongs to.
  [[nodiscard]] Carrier carrier_of(std::int32_t side) const { return faces_.face(side / 2).carrier[side % 2]; }
  /// Vertices of the result, without their position: where an original edge crosses a face, a triangle crosses an edge of the
  /// cut surface, and at a point of the cut surface, in the sector of this side.
  [[nodiscard]] CutVertex vertex_on_face(std::int32_t source_edge, std::int32_t side) const;
  [[nodiscard]] CutVertex vertex_on_edge(std::int32_t triangle, std::int32_t edge, std::int32_t side) const;
  [[nodiscard]] CutVertex vertex_at(std::int32_t point, std::int32_t level, std::int32_t side) const;

 private:
  void sort_around(FaceEdge& edge) const;
  [[nodiscard]] std::int32_t root_of(std::int32_t point, std::int32_t side) const;
  [[nodiscard]] bool in_air(std::int32_t side) const { return faces_.face(side / 2).air; }

  CutFaces& faces_;
  std::vector<std::int32_t> sorted_faces_, side_root_;  ///< of find_around
};

}  // namespace pliant::overlay
