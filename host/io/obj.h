// Wavefront OBJ output of a surface.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "geometry/mesh.h"

namespace pliant {

/// Normals and texture coordinates of corners, as OBJ has them: lists, and for every triangle which of them its corners have.
struct ObjCorners {
  std::vector<Vec3d> normals;                 ///< unit length
  std::vector<std::array<float, 2>> texture;  ///< u to the right, v up
  std::vector<std::array<std::int32_t, 3>> normal_of, texture_of;
  std::vector<std::uint8_t> cut;  ///< per triangle, not 0: made by a cut; empty: none
};

/// Write the surface with them; triangles of cuts form the group `cut`, the others `skin`. Throws Error as below.
void write_textured_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const ObjCorners& corners);

/// Write the surface; `normals` has one unit vector per vertex or is empty. Nine significant digits, which keep a float
/// exactly. Throws Error when the file cannot be written, when a triangle points outside the vertices, or when sizes disagree.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<Vec3d>& normals = {});

}  // namespace pliant
