// Tools that touch, through the API: driven by hand, felt without waiting, in checkpoints.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/c/pliant.h"
#include "scenes.h"
#include "support/temp_folder.h"
#include "tool_block.h"

namespace pliant {
namespace {

using test::code_of;

SceneSpec probe_over_block() {
  SceneSpec scene = test::bare_block();
  ToolSpec& probe = scene.tools.emplace_back();
  probe.name = "probe";
  probe.radius = 0.01;
  probe.path = {{0, 0, 0, 0.02, 0, 0, 0, 1}};
  return scene;
}

TEST(ApiContact, AWorldTellsWhatHappensWhileItRuns) {
  World world(probe_over_block(), {.backend = "cpu"});
  const auto told = [&](const std::string& words) {
    const std::vector<std::string> remarks = world.remarks();
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const std::string& r) { return r.find(words) != std::string::npos; });
  };
  EXPECT_EQ(world.remarks(), world.info().remarks);
  world.advance(0.02);
  EXPECT_TRUE(told("tool 'probe' has touched nothing until t = 0.0"));
  world.drive_tool("probe", {0, 0, 0.006}, {0, 0, 0, 1}, 0.2);
  world.advance(0.3);
  EXPECT_FALSE(told("tool 'probe' has touched nothing"));
  world.reset();
  world.step(1);
  EXPECT_TRUE(told("tool 'probe' has touched nothing"));
}

TEST(ApiContact, NamesAndPlacesAreCheckedAsInAFile) {
  SceneSpec scene = probe_over_block();
  scene.tools[0].name = "pro\nbe";
  EXPECT_EQ(code_of([&] { World(scene, {.backend = "cpu"}); }), ErrorCode::bad_input);
  scene = probe_over_block();
  scene.tools[0].path = {{0, 0, 0, -0.02, 0, 0, 0, 1}};
  EXPECT_EQ(code_of([&] { World(scene, {.backend = "cpu"}); }), ErrorCode::bad_input);
}

TEST(ApiContact, AToolDrivenAfterEquilibriumIsFollowedToTheNext) {
  SceneSpec scene = probe_over_block();
  scene.relaxation = RelaxationSpec{};
  World world(scene, {.backend = "cpu"});
  world.drive_tool("probe", {0, 0, 0.008}, {0, 0, 0, 1}, 0.05);
  while (!world.step(1000).at_equilibrium) {
  }
  const double first = world.tool_forces()[0].force[2];
  EXPECT_GT(first, 0.01);
  world.drive_tool("probe", {0, 0, 0.006}, {0, 0, 0, 1}, 0.05);
  const StepReport report = world.step(100000);
  EXPECT_TRUE(report.at_equilibrium);
  EXPECT_GT(report.done, 10);
  EXPECT_GT(world.tool_forces()[0].force[2], 1.5 * first);
}

TEST(ApiContact, AToolIsDrivenByHandAndFelt) {
  World world(probe_over_block(), {.backend = "cpu"});
  ASSERT_EQ(world.tool_forces().size(), 1u);
  EXPECT_EQ(world.tool_forces()[0].position, (Vec3d{0, 0, 0.02}));
  world.drive_tool("probe", {0, 0, 0.006}, {0, 0, 0, 1}, 0.2);
  world.advance(0.1);
  EXPECT_NEAR(world.tool_forces()[0].position[2], 0.013, 2e-4);
  world.advance(0.4);
  const ToolForce pressed = world.tool_forces()[0];
  EXPECT_EQ(pressed.name, "probe");
  EXPECT_EQ(pressed.position, (Vec3d{0, 0, 0.006}));
  // Hertz (1882) of a half space, which a block of finite depth exceeds.
  const double hertz = 4.0 / 3 * 1e4 / (1 - 0.45 * 0.45) * std::sqrt(0.01) * std::pow(0.004, 1.5);
  EXPECT_GT(pressed.force[2], hertz);
  EXPECT_LT(pressed.force[2], 1.6 * hertz);
  EXPECT_GT(pressed.area, 1e-5);
  EXPECT_LT(pressed.penetration, 0.001);
  world.drive_tool("probe", {0, 0, 0.03}, {0, 0, 0, 1});
  world.advance(0.5);
  EXPECT_EQ(world.tool_forces()[0].force, Vec3d{});
}

TEST(ApiContact, CheckpointsKeepWhereToolsAreDriven) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "driven.pckpt").string();
  World first(probe_over_block(), {.backend = "cpu"});
  first.drive_tool("probe", {0, 0, 0.006}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}, 0.2);
  first.step(100);
  first.save(file);
  first.step(200);
  World second(probe_over_block(), {.backend = "cpu"});
  second.load(file);
  second.step(200);
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_EQ(first.tool_forces()[0].force, second.tool_forces()[0].force);
  EXPECT_NE(first.tool_forces()[0].force, Vec3d{});
  first.reset();
  EXPECT_EQ(first.tool_forces()[0].position, (Vec3d{0, 0, 0.02}));
}

TEST(ApiContact, ForcesAreThereWithoutWaiting) {
  World world(probe_over_block(), {.backend = "cpu"});
  world.drive_tool("probe", {0, 0, 0.006}, {0, 0, 0, 1}, 0.05);
  ASSERT_TRUE(world.step_async(2000));
  bool felt = false;
  while (world.busy()) felt = felt || world.tool_forces()[0].force[2] > 0;
  world.wait();
  EXPECT_TRUE(felt);
}

TEST(ApiContact, MisuseIsRefused) {
  World world(probe_over_block(), {.backend = "cpu"});
  EXPECT_EQ(code_of([&] { world.drive_tool("prob", {}, {0, 0, 0, 1}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.drive_tool("probe", {0, std::nan(""), 0}, {0, 0, 0, 1}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.drive_tool("probe", {}, {0, 0, 0, 2}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.drive_tool("probe", {}, {0, 0, 0, 1}, 0); }), ErrorCode::usage);
}

TEST(ApiContact, InC) {
  const char* const text =
      R"({"format": "pliant-scene/1", "bodies": [{"name": "a", "surface": "memory:0", "lattice": {"spacing": 0.02},
    "material": {"young": 3000, "poisson": 0.45, "damping": 60}, "fixed": [{"box": [[-1, -1, -0.001], [1, 1, 0.001]]}]}],
    "tools": [{"name": "plate", "shape": {"half_space": [[0, 0, 0], [0, 0, -1]]}, "path": [[0, 0, 0, 0.05]]}]})";
  const SurfaceSpec box = box_surface({0, 0, 0}, {0.04, 0.04, 0.04});
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles;
  for (const Vec3d& v : box.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
  for (const Triangle& t : box.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  pliant_surface surface = PLIANT_SURFACE_INIT;
  surface.vertices = vertices.data();
  surface.vertex_count = box.vertices.size();
  surface.triangles = triangles.data();
  surface.triangle_count = box.triangles.size();
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text, nullptr, &surface, 1, nullptr, &world), PLIANT_OK) << pliant_last_error();
  const double position[3] = {0, 0, 0.038}, turn[4] = {0, 0, 0, 1};
  EXPECT_EQ(pliant_world_drive_tool(world, "plat", position, turn, 0.1), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_drive_tool(world, "plate", nullptr, turn, 0.1), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_drive_tool(world, "plate", position, nullptr, 0.1), PLIANT_USAGE);
  ASSERT_EQ(pliant_world_drive_tool(world, "plate", position, turn, 0.1), PLIANT_OK);
  ASSERT_EQ(pliant_world_step(world, 600, nullptr), PLIANT_OK);
  pliant_tool_force force = PLIANT_TOOL_FORCE_INIT;
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_tool_forces(world, &force, 1, &needed), PLIANT_OK);
  EXPECT_EQ(needed, 1u);
  EXPECT_STREQ(force.name, "plate");
  EXPECT_EQ(force.position[2], 0.038);
  EXPECT_EQ(force.turn[3], 1);
  // 5 % of a column that its foot holds: more than E and less than the stiffness without strain across.
  const double free = 3000 * 0.05 * 0.0016, held = free * 0.55 / (0.1 * 1.45);
  EXPECT_GT(force.force[2], free);
  EXPECT_LT(force.force[2], held);
  EXPECT_NEAR(force.area, 0.0016, 1e-5);
  EXPECT_NEAR(force.torque[0], 0.02 * force.force[2], 1e-4 * force.force[2]);
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
}

}  // namespace
}  // namespace pliant
