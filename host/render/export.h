// A surface in the form that files of animated surfaces take.
#pragma once
#include <span>
#include <vector>

#include "geometry/texture.h"
#include "io/gltf.h"
#include "io/obj.h"
#include "render/renderer.h"
#include "render/smooth_normals.h"

namespace pliant::render {

/// Vertices split along creases, rims of cuts and seams of a texture; which ones is decided when the topology changes, and
/// kept.
class FrameSplitter {
 public:
  /// `fields`: values at the vertices of `surface`. `texture`: coordinates per triangle, or empty.
  SurfaceFrame split(const Surface& surface, double time, const std::vector<VertexArray>& fields = {},
                     std::span<const TextureCorners> texture = {});

 private:
  void part(std::span<const float> positions, const Surface& surface, std::span<const TextureCorners> texture);

  SmoothNormals smooth_;
  std::vector<std::int32_t> corner_;  ///< [3 * triangles] the split vertex of each corner
  std::vector<std::int32_t> normal_;  ///< per split vertex, of the normals of smooth_
  std::vector<float> texture_;        ///< [2 * split vertices], or empty
  std::uint64_t topology_ = 0;
  bool ready_ = false;
};

/// The corners of the surface for an OBJ file: normals as FrameSplitter has them, and texture coordinates, each once.
ObjCorners obj_corners(const Surface& surface, std::span<const TextureCorners> texture);

}  // namespace pliant::render
