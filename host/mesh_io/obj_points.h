// The vertices of an OBJ file as its author numbered them.
#pragma once
#include <filesystem>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// The `v` lines, in the precision in which assimp hands them over. Throws Error for a coordinate that is no finite number; the
/// message has the file's own number of the vertex, which assimp loses. Independent of the locale.
std::vector<Vec3d> obj_points(const std::filesystem::path& file);

}  // namespace pliant
