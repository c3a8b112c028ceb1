#include "api/surfaces.h"

#include <fmt/format.h>

#include <charconv>

#include "geometry/mesh.h"
#include "pliant/error.h"

namespace pliant {

SurfaceSpec box_surface(const Vec3d& lower, const Vec3d& upper) {
  SurfaceSpec box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.push_back(
        {i & 1 ? upper[0] : lower[0], (i >> 1) & 1 ? upper[1] : lower[1], (i >> 2) & 1 ? upper[2] : lower[2]});
  }
  box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return box;
}

namespace api {

void set_surfaces(Scene& scene, const std::vector<SurfaceSpec>& surfaces) {
  const std::string memory = "memory:";
  for (Body& b : scene.bodies) {
    const std::string name = b.surface.filename().string();
    if (name.rfind(memory, 0) != 0) continue;
    std::size_t number = surfaces.size();
    std::from_chars(name.data() + memory.size(), name.data() + name.size(), number);
    if (number >= surfaces.size()) {
      throw Error(ErrorCode::bad_input, fmt::format("{}/surface: got \"{}\", but {} surfaces were given in memory", b.pointer,
                                                    name, surfaces.size()));
    }
    b.surface = name;
    b.surface_in_memory =
        std::make_shared<const TriangleMesh>(TriangleMesh{surfaces[number].vertices, surfaces[number].triangles});
  }
}

}  // namespace api
}  // namespace pliant
