// Triangle and volume meshes as read from files: plain arrays in metres.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

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

/// Read a surface (OBJ, STL, PLY, 3DS, glTF/glb and whatever else assimp reads). Polygons are triangulated, equal positions
/// welded, degenerate triangles dropped. Throws Error when missing, unreadable, empty or not finite, or if no triangle has
/// area.
TriangleMesh read_surface(const std::filesystem::path& file, double scale = 1, const Vec3d& translate = {});

/// The same for a surface in memory; `name` is for messages.
TriangleMesh clean_surface(const TriangleMesh& surface, const std::string& name, double scale = 1, const Vec3d& translate = {});

/// Read a volume mesh: Gmsh .msh (versions 1, 2 and 4, text; 2 and 4 also binary), VTK legacy, VTU, TetGen (.node/.ele).
/// Unused vertices are dropped; tetrahedra of negative volume are an error that names the element unless all are negative
/// (then the file's orientation convention is swapped).
VolumeMesh read_volume(const std::filesystem::path& file, double scale = 1, const Vec3d& translate = {});

/// The boundary triangles of a volume mesh (outward), over the mesh's own vertices (quads are split in two).
std::vector<std::array<std::int32_t, 3>> boundary_triangles(const VolumeMesh& mesh);

/// Enclosed volume by the divergence theorem [m^3] (meaningful for closed surfaces).
double signed_volume(const TriangleMesh& mesh);

}  // namespace pliant
