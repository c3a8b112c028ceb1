// A SceneSpec as the text of a scene file, so that scenes in code and scenes in files pass the same checks.
#pragma once
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "scene/scene.h"

namespace pliant::api {

/// The text; surfaces in memory appear as "memory:0", "memory:1", ... in the order of `surfaces`.
std::string scene_text(const SceneSpec& spec, std::vector<SurfaceSpec>& surfaces);

/// Read the text of a scene; "memory:N" names surfaces[N]. Throws Error (input).
Scene read_scene(const std::string& text, const std::string& file, const std::vector<SurfaceSpec>& surfaces);

}  // namespace pliant::api
