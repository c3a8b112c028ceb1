// A World for tests of the C API.
#pragma once
#include <gtest/gtest.h>

#include "pliant/c/pliant.h"
#include "pliant/scene.h"

namespace pliant::test {

/// Points to the arrays of `surface`.
inline pliant_surface c_surface(const SurfaceSpec& surface) {
  pliant_surface out = PLIANT_SURFACE_INIT;
  out.vertices = surface.vertices[0].data();
  out.vertex_count = surface.vertices.size();
  out.triangles = surface.triangles[0].data();
  out.triangle_count = surface.triangles.size();
  return out;
}

/// A cube of 4 cm from the origin, held at z = 0, in cells of 2 cm; destroyed at the end.
class CCube {
 public:
  CCube() {
    const char* const text = R"({"format": "pliant-scene/1", "bodies": [{"name": "a", "surface": "memory:0",
      "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45, "damping": 60},
      "fixed": [{"box": [[-1, -1, -0.001], [1, 1, 0.001]]}]}]})";
    const SurfaceSpec box = box_surface({0, 0, 0}, {0.04, 0.04, 0.04});
    const pliant_surface surface = c_surface(box);
    pliant_options options = PLIANT_OPTIONS_INIT;
    options.backend = "cpu";
    EXPECT_EQ(pliant_world_parse(text, nullptr, &surface, 1, &options, &world_), PLIANT_OK) << pliant_last_error();
  }
  ~CCube() { EXPECT_EQ(pliant_world_destroy(world_), PLIANT_OK); }
  CCube(const CCube&) = delete;
  CCube& operator=(const CCube&) = delete;
  operator pliant_world() const { return world_; }  // NOLINT(google-explicit-constructor): stands for it in every call

 private:
  pliant_world world_{};
};

}  // namespace pliant::test
