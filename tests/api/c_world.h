// A World for tests of the C API.
#pragma once
#include <gtest/gtest.h>

#include "pliant/c/pliant.h"
#include "pliant/scene.h"

namespace pliant::test {

/// A cube of 4 cm from the origin, held at z = 0, in cells of 2 cm; destroyed at the end.
class CCube {
 public:
  CCube() {
    const char* const text = R"({"format": "pliant-scene/1", "bodies": [{"name": "a", "surface": "memory:0",
      "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45, "damping": 60},
      "fixed": [{"box": [[-1, -1, -0.001], [1, 1, 0.001]]}]}]})";
    const SurfaceSpec box = box_surface({0, 0, 0}, {0.04, 0.04, 0.04});
    pliant_surface surface = PLIANT_SURFACE_INIT;
    surface.vertices = box.vertices[0].data();
    surface.vertex_count = box.vertices.size();
    surface.triangles = box.triangles[0].data();
    surface.triangle_count = box.triangles.size();
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
