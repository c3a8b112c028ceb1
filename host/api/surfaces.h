// Surfaces in memory.
#pragma once
#include <vector>

#include "pliant/scene.h"
#include "scene/scene.h"

namespace pliant::api {

/// Sets surfaces[N] for bodies of a scene from text whose surface is "memory:N". Throws Error (input) if there is none.
void set_surfaces(Scene& scene, const std::vector<SurfaceSpec>& surfaces);

}  // namespace pliant::api
