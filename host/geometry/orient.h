// Consistent, outward winding for surfaces whose files do not guarantee it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"

namespace pliant {

/// What orient_outward found and did.
struct OrientationReport {
  std::vector<std::int32_t> shell;  ///< per triangle: the connected component it belongs to
  std::int32_t shells = 0;          ///< how many there are
  std::int64_t flipped = 0;         ///< triangles whose winding was reversed
  /// Edges that its triangles, as wound now, do not run equally often both ways: the rims of holes, and the seams of one-sided
  /// surfaces. Away from them winding numbers jump by whole numbers across the surface and vary smoothly elsewhere.
  std::vector<std::array<std::int32_t, 2>> rim;
  [[nodiscard]] bool closed() const { return rim.empty(); }
};

/// Wind all triangles of a shell the same way, by flooding over its edges: those that exactly two triangles share, and those
/// where parts of the surface touch or overlap, which evenly many triangles run equally often both ways; then turn each shell
/// outward, by the sign of its volume about its own area centroid (open shells are treated as nearly closed). One exception: a
/// shell that lies inside another one and was, by a clear majority of its area, wound opposite to it is a cavity and stays
/// inward. The result does not depend on how many triangles were flipped at random before, as long as that majority survives.
OrientationReport orient_outward(TriangleMesh& mesh);

}  // namespace pliant
