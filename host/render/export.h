// A surface in the form that files of animated surfaces take.
#pragma once
#include "io/gltf.h"
#include "render/renderer.h"
#include "render/smooth_normals.h"

namespace pliant::render {

/// Vertices split along creases and rims of cuts; which ones is decided when the topology changes, and kept.
class FrameSplitter {
 public:
  /// `fields`: values at the vertices of `surface`.
  SurfaceFrame split(const Surface& surface, double time, const std::vector<VertexArray>& fields = {});

 private:
  SmoothNormals smooth_;
  std::uint64_t topology_ = 0;
  bool ready_ = false;
};

}  // namespace pliant::render
