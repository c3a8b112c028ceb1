// Texture coordinates of triangles: plain arrays.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Of the three corners of a triangle: u to the right and v up, as in OBJ files.
using TextureCorners = std::array<std::array<float, 2>, 3>;

/// What maps a picture onto a surface as its file has it. Corners in one place may have several coordinates, at seams.
struct SurfaceTexture {
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< vertices
  std::vector<TextureCorners> corners;                 ///< per triangle
};

}  // namespace pliant
