// Defects of triangle surfaces: duplicate triangles, holes, loose sheets, self-intersections.
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/orient.h"

namespace pliant {

/// A closed loop of edges that border the surface on one side only.
struct Hole {
  Vec3d centre{};          ///< mean of its vertices [m]
  double area = 0;         ///< of the triangles from its edges to the centre [m^2]
  double volume = 0;       ///< that these triangles add to signed_volume [m^3]
  std::int64_t edges = 0;  ///< around it
};

/// The holes of a mesh that is wound consistently, largest first.
std::vector<Hole> holes_of(const TriangleMesh& mesh);

/// Triangles that have the vertices of an earlier one, and those of them without which the surface has no more edges of an odd
/// number of triangles than with them. The others belong to closed parts that touch or overlap.
struct Copies {
  std::int64_t found = 0;
  std::int64_t dropped = 0;
  std::vector<char> drop;   ///< per triangle; empty: none
  std::int32_t first = -1;  ///< the first that is dropped, or else found
};
Copies copies_of(const TriangleMesh& mesh);

/// A shell whose own rim spans more than this share of its area has no inside.
inline constexpr double kLargestHole = 0.25;

/// Per triangle, whether it belongs to a sheet: a shell that has no inside and without which the others are no more open.
/// Empty if there are none.
std::vector<char> sheets_of(const TriangleMesh& mesh, const OrientationReport& orientation);

/// The same vertices without the marked triangles.
TriangleMesh without(const TriangleMesh& mesh, const std::vector<char>& drop);

/// Area of triangle t [m^2], and its centroid [m].
double area_of(const TriangleMesh& mesh, std::int64_t t);
Vec3d centroid_of(const TriangleMesh& mesh, std::int64_t t);

/// Counts pairs of triangles without a common vertex that intersect (touching and coplanar ones do not). The search stops
/// after an amount of work, counted in candidates, that suffices for 100 000 triangles of a typical surface.
struct Crossings {
  std::int64_t pairs = 0;
  std::int64_t between_shells = 0;  ///< of these: pairs of two shells
  Vec3d place{};                    ///< on one of the first pair [m]
  double searched = 1;              ///< fraction of the triangles that were tested
};
Crossings crossings_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& shell, std::int64_t budget = 8'000'000);

}  // namespace pliant
