// The cells that a blade can cut: cells of a lattice (six Kuhn tetrahedra, 19 edges) and tetrahedra (one, six edges); and how
// the inside of a cut cell is divided.
//
// A tetrahedron is divided at one point per edge, one per face and its centre into 24 tetrahedra, one per flag (vertex, edge,
// face): the flag's tetrahedron (v, e, f, c) belongs to the component of its vertex v. The interface between two components is
// made of the triangles (e, f, c) where the two ends of e differ. Points of edges and faces depend on what neighbours share, so
// both sides of a face are divided alike. Once an interface has a point, the point stays: later cuts divide what lies on either
// side, and move no former cut, so every part keeps the volume that it had.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "scene/scene.h"

namespace pliant {

/// Minimum distance of a cut from both ends of its edge, as a fraction of its length, so that no part of a cell has zero
/// volume.
inline constexpr double kLeastCrossing = 1e-3;

/// Corners, tetrahedra, edges and faces of one kind of cell, by local corner numbers. Edges are those of the tetrahedra.
struct CellShape {
  int corners;
  std::span<const std::array<int, 4>> tets;   ///< positive volume
  std::span<const std::array<int, 2>> edges;  ///< lower corner first; of a lattice cell the first 12 are its axis edges
  std::span<const std::array<int, 4>> faces;  ///< a tetrahedron's repeat their last corner
  /// Number in `edges` of the edge between two corners, -1 if they have none.
  std::array<std::array<std::int8_t, 8>, 8> edge_of{};
};
const CellShape& lattice_cell_shape();
const CellShape& tetrahedron_shape();

/// Corners of the six edges and four faces of a tetrahedron; face i lies opposite corner i, its corners counter-clockwise from
/// outside.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// Number in kTetEdges of the edge between two corners.
inline constexpr std::array<std::array<int, 4>, 4> kTetEdgeOf{{{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}}};

/// The points at which one tetrahedron is divided, at rest [m].
struct CutTet {
  std::array<std::int32_t, 4> node{};  ///< nodes of the uncut body
  std::array<int, 4> label{};          ///< component of each corner
  std::array<Vec3d, 4> corner{};
  std::array<Vec3d, 6> edge{};  ///< where it is cut; the middle if it is not
  std::array<Vec3d, 4> face{};  ///< DivisionPoints
  Vec3d centre{};
  std::array<char, 6> cut{};  ///< whether the edge is cut
  [[nodiscard]] bool mixed() const { return label[0] != label[1] || label[0] != label[2] || label[0] != label[3]; }
};

/// Of which cut points, as bits of kTetEdges, the points of the faces and the centre are the mean; 0: they are centroids.
struct DivisionPoints {
  std::array<std::uint8_t, 4> face{};  ///< of the edges that were cut when the face had two of them
  std::uint8_t centre = 0;  ///< of those between different labels when there first were two (CutDivision::place_centres)
};
/// Which of a face's edges its point is the mean of, given when they were cut; negative: not at all.
inline std::array<bool, 3> at_face_point(const std::array<std::int32_t, 3>& when) {
  std::array<std::int32_t, 3> sorted = when;
  std::sort(sorted.begin(), sorted.end());
  const std::int32_t second = sorted[0] < 0 ? sorted[2] : sorted[1];
  std::array<bool, 3> out{};
  if (sorted[1] < 0) return out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = when[i] >= 0 && when[i] <= second;
  return out;
}

/// The same division by barycentric coordinates. The share of the flag (v, e, f) in the tetrahedron's volume is
/// centre[i] face[i][j] s, with i the corner opposite f, j that opposite e in f, and s the share of e between v and its point.
struct TetDivision {
  std::array<double, 6> edge{};  ///< share of the way from the first to the second corner of kTetEdges
  std::array<std::array<double, 4>, 4> face{};
  std::array<double, 4> centre{};
};
/// Ignores `crossing` for edges that are not `cut`.
TetDivision divide(const DivisionPoints& points, const std::array<char, 6>& cut, const std::array<double, 6>& crossing);
/// Returns the volume fractions of the corners' flags, with sum 1.
std::array<double, 4> corner_shares(const TetDivision& division);
/// The corner whose flags hold a point given by its barycentric coordinates; for one outside those nearest along the ray from
/// the centre.
int corner_at(const TetDivision& division, const std::array<double, 4>& point);

}  // namespace pliant
