// Surfaces in memory.
#pragma once
#include <vector>

#include "pliant/scene.h"
#include "scene/scene.h"

namespace pliant::api {

/// Bodies of a scene from text whose surface is "memory:N" get surfaces[N]. Throws Error (input) if there is none.
void set_surfaces(Scene& scene, const std::vector<SurfaceSpec>& surfaces);

}  // namespace pliant::api
