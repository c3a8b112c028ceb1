// The surfaces of tools, for those who draw them.
#include <gtest/gtest.h>

#include <cmath>

#include "c_world.h"
#include "geometry/mesh.h"
#include "geometry/vec.h"
#include "scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using test::code_of;
using test::on;

ToolSpec tool(const std::string& name, const std::string& shape) {
  ToolSpec tool;
  tool.name = name;
  tool.shape = shape;
  tool.path = {{0, 1, 2, 3, 0, 0, 0, 1}};
  return tool;
}

double volume(const SurfaceSpec& s) { return signed_volume({s.vertices, s.triangles}); }

TEST(ToolSurface, IsThatOfTheShapeInItsOwnFrame) {
  SceneSpec scene = test::block();
  ToolSpec ball = tool("ball", "sphere"), rod = tool("rod", "capsule"), bar = tool("bar", "box");
  ball.radius = 0.02;
  rod.radius = 0.01;
  rod.first = {0, 0, 0.1};
  rod.second = {0, 0, 0.2};
  bar.size = {0.1, 0.2, 0.3};
  scene.tools = {ball, rod, bar};
  World world(scene, on("cpu"));
  const SurfaceSpec round = world.tool_surface("ball");
  for (const Vec3d& v : round.vertices) EXPECT_NEAR(vec::norm(v), 0.02, 1e-12);
  EXPECT_NEAR(volume(round) / (4.0 / 3 * M_PI * 8e-6), 1, 0.01) << "outward";
  for (const Vec3d& v : world.tool_surface("rod").vertices) {
    const Vec3d axis{0, 0, std::min(0.2, std::max(0.1, v[2]))};
    EXPECT_NEAR(vec::norm(vec::sub(v, axis)), 0.01, 1e-12);
  }
  EXPECT_NEAR(volume(world.tool_surface("bar")), 0.1 * 0.2 * 0.3, 1e-15);
  const SurfaceSpec before = world.tool_surface("bar");
  world.place_tool("bar", {2, 2, 2});
  world.park_tool("bar");
  EXPECT_EQ(world.tool_surface("bar").vertices, before.vertices) << "its own frame does not move with it";
  EXPECT_EQ(code_of([&] { (void)world.tool_surface("nothing"); }), ErrorCode::usage);
  world.remove_tool("ball");
  EXPECT_NEAR(volume(world.tool_surface("bar")), 0.1 * 0.2 * 0.3, 1e-15) << "names stay with their shapes";
  EXPECT_EQ(code_of([&] { (void)world.tool_surface("ball"); }), ErrorCode::usage);
}

/// Half a turn about x takes the plane, above the block, to z < 0 of its own frame.
TEST(ToolSurface, OfAHalfSpaceReachesPastTheBodies) {
  SceneSpec scene = test::block();
  ToolSpec table = tool("table", "half_space");
  table.first = {0, -0.5, 0};
  table.second = {0, 1, 0};
  table.path = {{0, 0, 0.2, 0, 1, 0, 0, 0}};
  scene.tools = {table};
  World world(scene, on("cpu"));
  const SurfaceSpec plane = world.tool_surface("table");
  ASSERT_EQ(plane.triangles.size(), 2U);
  double least = 1, most = -1;
  for (const Vec3d& v : plane.vertices) {
    EXPECT_NEAR(v[1], -0.5, 1e-12);
    least = std::min(least, v[0]);
    most = std::max(most, v[0]);
  }
  EXPECT_LT(least, 0);
  EXPECT_GT(most, 0.1) << "over the whole block";
  const std::array<std::int32_t, 3>& t = plane.triangles[0];
  const auto at = [&](std::size_t c) { return plane.vertices[static_cast<std::size_t>(t[c])]; };
  EXPECT_GT(vec::cross(vec::sub(at(1), at(0)), vec::sub(at(2), at(0)))[1], 0) << "outward";
}

TEST(ToolSurface, OfASequenceChangesInTime) {
  World world = World::open(test::source_dir() + "/scenes/hand_bunny.json", on("cpu"));
  const SurfaceSpec open = world.tool_surface("hand");
  EXPECT_GT(volume(open), 0);
  world.advance(0.1);
  const SurfaceSpec closed = world.tool_surface("hand");
  EXPECT_NE(open.vertices, closed.vertices);
  EXPECT_NEAR(volume(closed) / volume(open), 1, 0.2);
}

TEST(ToolSurface, InC) {
  const test::CCube world;
  const char* const bar = R"({"name": "bar", "shape": {"box": [0.1, 0.2, 0.3]}, "path": [[0, 1, 1, 1]]})";
  ASSERT_EQ(pliant_world_parse_tool(world, bar, nullptr, nullptr, 0), PLIANT_OK) << pliant_last_error();
  std::size_t vertices = 0, triangles = 0;
  ASSERT_EQ(pliant_world_tool_surface(world, "bar", nullptr, 0, nullptr, 0, &vertices, &triangles), PLIANT_OK);
  EXPECT_EQ(vertices, 8U);
  EXPECT_EQ(triangles, 12U);
  double x[9] = {0, 0, 0, 0, 0, 0, 7, 7, 7};
  std::int32_t corners[36] = {};
  ASSERT_EQ(pliant_world_tool_surface(world, "bar", x, 2, corners, 12, nullptr, nullptr), PLIANT_OK);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(std::abs(x[3 + c]), 0.05 * (c + 1));
  EXPECT_EQ(x[6], 7) << "no further than there is room";
  for (const std::int32_t v : corners) EXPECT_TRUE(v >= 0 && v < 8);
  EXPECT_EQ(pliant_world_tool_surface(world, nullptr, x, 2, corners, 12, nullptr, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_tool_surface(world, "rod", x, 2, corners, 12, nullptr, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_tool_surface(world, "bar", nullptr, 2, corners, 12, nullptr, nullptr), PLIANT_USAGE);
}

}  // namespace
}  // namespace pliant
