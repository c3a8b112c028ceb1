// Wavefront OBJ output of a surface.
#pragma once
#include <filesystem>
#include <vector>

#include "geometry/mesh.h"

namespace pliant {

/// Write the surface; `normals` has one unit vector per vertex or is empty. Nine significant digits, which keep a float
/// exactly. Throws Error when the file cannot be written, when a triangle points outside the vertices, or when sizes disagree.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<Vec3d>& normals = {});

}  // namespace pliant
