// Samples, filter, picture.
#pragma once
#include "render/ray_scene.h"

namespace pliant::render {

Image trace(const RayScene& scene, const Camera& camera, const RenderOptions& options, int threads);

}  // namespace pliant::render
