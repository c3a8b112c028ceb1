// Surfaces and volume meshes from files.
#pragma once
#include <filesystem>
#include <string>

#include "geometry/mesh.h"
#include "geometry/texture.h"

namespace pliant {

struct MeshTags;
struct SurfaceReport;

/// Read a surface (OBJ, STL, PLY, 3DS, glTF/glb and whatever else assimp reads). Polygons are triangulated, equal positions
/// welded, degenerate triangles and superfluous copies dropped; `report` says what (surface_report.h). Throws Error when
/// missing, unreadable, empty or not finite, or if no triangle has area. `texture`: of every triangle; empty if the file has no
/// texture coordinates, or is a PLY.
TriangleMesh read_surface(const std::filesystem::path& file, double scale = 1, const Vec3d& translate = {},
                          SurfaceReport* report = nullptr, std::vector<TextureCorners>* texture = nullptr);

/// The same for a surface in memory; `name` is for messages.
TriangleMesh clean_surface(const TriangleMesh& surface, const std::string& name, double scale = 1, const Vec3d& translate = {},
                           SurfaceReport* report = nullptr);

/// Read a volume mesh: Gmsh .msh (versions 1, 2 and 4, text; 2 and 4 also binary), VTK legacy, VTU, TetGen (.node/.ele).
/// Unused vertices are dropped; tetrahedra of negative volume are an error that names the element unless all are negative
/// (then the file's orientation convention is swapped). `tags`: further data of its cells (mesh_tags.h).
VolumeMesh read_volume(const std::filesystem::path& file, double scale = 1, const Vec3d& translate = {},
                       MeshTags* tags = nullptr);

}  // namespace pliant
