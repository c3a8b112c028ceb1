// Triangle and volume meshes: plain arrays in metres.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

struct TriangleMesh {
  std::vector<Vec3d> vertices;                         ///< [m]
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< outward by the right-hand rule
};

/// A volume mesh: tetrahedra, or hexahedra in VTK order (bottom face counter-clockwise, then top).
struct VolumeMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::array<std::int32_t, 8>> hexes;
};

/// The boundary triangles of a volume mesh (outward), over the mesh's own vertices (quads are split in two).
std::vector<std::array<std::int32_t, 3>> boundary_triangles(const VolumeMesh& mesh);

/// Enclosed volume by the divergence theorem [m^3] (meaningful for closed surfaces).
double signed_volume(const TriangleMesh& mesh);

}  // namespace pliant
