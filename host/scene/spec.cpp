#include "scene/spec.h"

#include <fmt/format.h>

#include "geometry/mesh.h"
#include "pliant/error.h"
#include "scene/parts.h"

namespace pliant {
namespace {

void check_sizes(const BodySpec& b) {
  for (std::size_t l = 0; l < b.springs.size(); ++l) {
    const SpringListSpec& list = b.springs[l];
    for (const auto& [numbers, name] : {std::pair(&list.factor, "factor"), std::pair(&list.length, "length")}) {
      if (numbers->empty() || numbers->size() == list.nodes.size()) continue;
      throw Error(ErrorCode::bad_input, fmt::format("body \"{}\": springs {}: got {} numbers \"{}\", expected none or one for "
                                                    "each of the {} springs",
                                                    b.name, l, numbers->size(), name, list.nodes.size()));
    }
  }
}

}  // namespace

/// The scene goes the way of a file, so that both doors have one set of rules and of messages.
Scene scene_of(const SceneSpec& spec) {
  for (const BodySpec& b : spec.bodies) {
    check_sizes(b);
    if (int{in_memory(b)} + int{!b.surface_file.empty()} + int{!b.volume_file.empty()} == 1) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("body \"{}\": exactly one of surface, surface_file and volume_file must be set", b.name));
  }
  Scene scene = read_document(document_of(spec), {});
  std::size_t surfaces = 0;
  for (std::size_t b = 0; b < spec.bodies.size(); ++b) {
    if (!in_memory(spec.bodies[b])) continue;
    const SurfaceSpec& surface = spec.bodies[b].surface;
    scene.bodies[b].surface = fmt::format("memory:{}", surfaces++);
    scene.bodies[b].surface_in_memory = std::make_shared<const TriangleMesh>(TriangleMesh{surface.vertices, surface.triangles});
  }
  return scene;
}

}  // namespace pliant
