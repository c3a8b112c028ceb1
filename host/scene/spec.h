// Converts the public SceneSpec to the internal Scene.
#pragma once
#include "pliant/scene.h"
#include "scene/scene.h"

namespace pliant {

/// Throws Error (input) as load_scene does; places are named as in a scene file. Surfaces in memory get the names "memory:0",
/// "memory:1", ... in the order of the bodies.
Scene scene_of(const SceneSpec& spec);

}  // namespace pliant
