// Defects of a surface from a file or from memory before it was repaired, and whether it encloses a body.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/defects.h"
#include "geometry/mesh.h"

namespace pliant {

/// Places are in metres, and of the first that was found.
struct SurfaceReport {
  std::string name;         ///< of the file
  std::int64_t merged = 0;  ///< points merged with another at the same position
  Vec3d merged_at{};
  std::int64_t degenerate = 0;  ///< triangles without area, dropped
  Vec3d degenerate_at{};
  std::int64_t doubled = 0, doubled_dropped = 0;  ///< triangles that coincide with another one (geometry/defects.h: Copies)
  Vec3d doubled_at{};
  std::int64_t triangles = 0, flipped = 0;  ///< remaining triangles, and those of them that were reversed to face outward
  Vec3d flipped_at{};
  std::int64_t sheet_triangles = 0;  ///< of sheets that bound nothing (sheets_of), which are left out of the filling
  Vec3d sheet_at{};
  double area = 0, sheet_area = 0;  ///< of all triangles, of sheets [m^2]
  std::vector<Hole> holes;          ///< of the rest
  double volume = 0;                ///< of the rest, the holes closed [m^3]; where parts overlap, more than once
  std::vector<std::int32_t> shell;  ///< per triangle

  [[nodiscard]] double hole_area() const;
  [[nodiscard]] std::int64_t hole_edges() const;
};

/// Throws Error if the surface has no inside.
void require_inside(const SurfaceReport& report);

/// Sentences that a user should read, none for a sound surface. `crossings` and `filled`, the volume of the lattice [m^3], say
/// data that the report lacks.
std::vector<std::string> surface_warnings(const SurfaceReport& report, const Crossings& crossings, double filled);

}  // namespace pliant
