#include "model/contact/tool_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "geometry/mesh_overlap.h"
#include "surfaces.h"

namespace pliant::tool_mesh_test {

ToolForm round_form(ToolShape shape, double radius, const Vec3d& first, const Vec3d& second) {
  ToolForm form;
  form.shape = shape;
  form.radius = radius;
  form.first = first;
  form.second = second;
  return form;
}

TEST(ToolMesh, RoundToolsHaveTheirVolume) {
  const double r = 0.013;
  const Vec3d first{0.01, -0.02, 0.03}, second{0.05, 0.04, 0};
  const double length = vec::norm(vec::sub(second, first)), ball = 4 * std::numbers::pi * r * r * r / 3;
  for (const int around : {16, 64, 256}) {
    const ToolForm sphere = round_form(ToolShape::sphere, r, {}, {}), rod = round_form(ToolShape::capsule, r, first, second);
    EXPECT_NEAR(signed_volume(tool_mesh_of_volume(sphere, around)) / ball, 1, 1e-12);
    const double whole = ball + std::numbers::pi * r * r * length;
    EXPECT_NEAR(signed_volume(tool_mesh_of_volume(rod, around)) / whole, 1, 1e-12);
    EXPECT_LT(signed_volume(tool_mesh(rod, around)), whole) << "its corners lie on the round surface";
  }
}

/// Caps from a tenth of the radius on, from all sides, at the resolution of Interpenetrations.
TEST(ToolMesh, ShallowCapsOfRoundTools) {
  const TriangleMesh sphere = tool_mesh_of_volume(round_form(ToolShape::sphere, 1, {}, {}), 256);
  for (const double height : {0.1, 0.3, 1.0}) {
    const double cap = std::numbers::pi * height * height * (3 - height) / 3, edge = 1 - height;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3d low{-2, -2, -2}, high{2, 2, 2};
      low[axis] = edge;
      const MeshOverlap above = mesh_overlap(sphere, test::box(low, {2, 2, 2}));
      EXPECT_NEAR(above.volume / cap, 1, 1e-3) << height << " along " << axis;
      EXPECT_NEAR(above.area[0] / (2 * std::numbers::pi * height), 1, 1e-3);
      high[axis] = -edge;
      EXPECT_NEAR(mesh_overlap(test::box({-2, -2, -2}, high), sphere).volume / cap, 1, 1e-3);
    }
  }
}

}  // namespace pliant::tool_mesh_test
