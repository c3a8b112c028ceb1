// Triangles of the tools of a scene, for pictures.
#pragma once
#include <cstdint>
#include <vector>

#include "simulation/measure/tool_shapes.h"

namespace pliant::render {

/// The body number of triangles that belong to tools.
inline constexpr std::int32_t kToolBody = -1;

/// All tools where they are now. Shapes are made once.
class ToolSurfaces {
 public:
  /// Appends vertices (x, y, z) and triangles behind those that are there.
  void append(const Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles);

 private:
  ToolShapes shapes_{kToolSides};
};

}  // namespace pliant::render
