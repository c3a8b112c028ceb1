// A block of plain elements and blades of any method, for tests of cuts in running bodies.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "cutting/mesh_files.h"
#include "support/temp_folder.h"

namespace pliant::cut_test {

inline Blade with_method(BladeMethod method, const std::string& name, std::vector<std::array<double, 7>> path) {
  Blade out = blade(name, std::move(path));
  out.method = method;
  return out;
}

struct BlockScenes : ::testing::Test {
  test::TempFolder folder;
  std::filesystem::path file = tet_box_file(folder, "block.msh", 6, 4, 4);

  /// A block of 6 x 4 x 4 cm, held at its left end, with a blade that is far from it until it is moved.
  [[nodiscard]] Scene block(BladeMethod method, ElementKind element = ElementKind::tet4) const {
    Body body;
    body.name = "block";
    body.mesh = file;
    body.element = element;
    body.material.set_moduli(Law::neo_hookean, Moduli::from_lame(4000, 1000));
    body.material.damping = 20;
    hold(body, {0, 0, 0}, {-1, 0, 0});
    Scene scene = scene_with(body);
    scene.blades.push_back(with_method(method, "far", {{0, 5, 5, 5, 5, 5, 6}, {1, 5, 6, 5, 5, 6, 6}}));
    return scene;
  }
  /// The same, cut through in the leaning plane x = 0.033 + 0.3 (y - 0.02) within 0.2 s.
  [[nodiscard]] Scene cut_through(BladeMethod method) const {
    Scene scene = block(method);
    scene.blades = {
        with_method(method, "scalpel",
                    {{0, 0.0252, -0.006, -0.01, 0.0252, -0.006, 0.05}, {0.2, 0.0408, 0.046, -0.01, 0.0408, 0.046, 0.05}})};
    return scene;
  }
  /// Pulled to one and a half times its length.
  static Scene pulled(Scene scene) {
    pull(scene.bodies[0], {0.06, 0, 0}, {1, 0, 0}, {0.03, 0, 0}, 0.2);
    return scene;
  }
};

inline double volume_of(const Simulation& s) { return signed_volume({s.model().surface.rest, s.model().surface.triangles}); }

/// A blade goes from somewhere near the block to somewhere else while it moves.
template <class Any>
void random_stroke(Simulation& s, const std::string& name, Any&& any) {
  const auto point = [&] {
    const double x = any(), y = any(), z = any();
    return Vec3d{0.09 * x - 0.01, 0.06 * y - 0.01, 0.06 * z - 0.01};
  };
  const BladeSegment from{point(), point()}, to{point(), point()};
  for (int k = 0; k <= 6; ++k) {
    BladePose pose{name, {}};
    for (std::size_t end = 0; end < 2; ++end)
      pose.segment[end] = vec::add(from[end], vec::mul(vec::sub(to[end], from[end]), k / 6.0));
    s.move_blades(std::span(&pose, 1));
    s.advance(s.next_batch(16));
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  }
}

}  // namespace pliant::cut_test
