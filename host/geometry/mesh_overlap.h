// What two closed surfaces have in common: volume, centroid, areas and the deepest point.
#pragma once
#include <array>
#include <cstdint>

#include "geometry/mesh.h"

namespace pliant {

struct MeshOverlap {
  double volume = 0;             ///< [m^3]
  Vec3d centroid{};              ///< of this volume [m]; only if it is above 0
  std::array<double, 2> area{};  ///< of the surface of each mesh that lies inside the other [m^2]
  double depth = 0;           ///< largest distance of a vertex of either mesh, inside the other, from the other's surface [m]
  Vec3d deepest{};            ///< this vertex [m]; only if there is one
  std::int64_t compared = 0;  ///< pairs of triangles that were compared: the cost
};

/// The overlap of two closed meshes with outward triangles, of any number of parts.
///
/// The inside of a closed surface is the signed sum of the columns above its triangles, and as well that of the columns below
/// them (Lien and Kajiya 1984). Above for one mesh, below for the other, the overlap is the sum over pairs of triangles of the
/// space between them where their projections intersect: polynomials over convex polygons. Nothing is decided exactly, and
/// nothing has to be: an error of rounding changes the sum by as little. Errors are some 1e-15 of the volume of the box that
/// both boxes have in common. Space that is inside a mesh several times counts as often. Surface that lies in the other's
/// counts half. The work is in proportion to the triangles above and below that box along one axis, the best for the volume
/// (but for a test of the box of each triangle); areas are measured along all three, each triangle along that nearest to its
/// normal. The deepest point takes a tree over the triangles near that box.
MeshOverlap mesh_overlap(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace pliant
