// What a freely running World shows: no state that it is about to take back.
#include "api/trust.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "api/scenes.h"
#include "support/source_dir.h"

namespace pliant::trust_test {
namespace {

using namespace test;

/// A cube thrown at a table, whose first steps are too long: they are taken back at the end of the first grid step.
Scene thrown_cube() {
  return parse_scene(R"({"format": "pliant-scene/1", "gravity": [0, 0, 0], "bodies": [{"name": "cube",
    "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "velocity": [0, -3, 0],
    "material": {"young": 3000, "poisson": 0.4, "density": 1000, "damping": 5}}],
    "tools": [{"name": "table", "shape": {"half_space": [[0, -0.055, 0], [0, 1, 0]]}}]})",
                     source_dir() + "/scenes/thrown.json");
}

TEST(Trust, IsNotGivenToWhatIsTakenBack) {
  Simulation simulation(thrown_cube(), open_backend("cpu"));
  api::Trust trust;
  trust.renew(simulation);
  trust.look(simulation, true);
  EXPECT_TRUE(trust.given());
  simulation.advance(12);
  ASSERT_FALSE(simulation.settled());
  ASSERT_GT(simulation.report().tools[0].max_force, 50) << "the steps are too long, and the table throws the cube";
  trust.look(simulation, true);
  EXPECT_FALSE(trust.given());
  const ForceSample felt{{}, 3, 0};
  EXPECT_TRUE(trust.told({felt}).empty());
  trust.look(simulation, false);
  EXPECT_TRUE(trust.given()) << "who steps sees all";
  EXPECT_EQ(trust.told({felt}).size(), 1U);
}

TEST(Trust, IsGivenToAFastFlight) {
  Scene scene = thrown_cube();
  scene.tools.clear();
  scene.gravity = {0, -9.81, 0};
  Simulation simulation(scene, open_backend("cpu"));
  api::Trust trust;
  trust.renew(simulation);
  for (int i = 0; i < 200; ++i) {
    simulation.advance(simulation.next_batch(7));
    trust.look(simulation, true);
    EXPECT_TRUE(trust.given()) << simulation.step();
  }
}

TEST(Trust, AWorldShowsNoForceOfABurst) {
  Simulation settled(thrown_cube(), open_backend("cpu"));
  while (settled.step() < 128) settled.advance(128 - settled.step());
  const double most = settled.report().tools[0].max_force;
  World world = WorldAccess::make(thrown_cube(), [](std::string* why, std::int64_t) { return open_backend("cpu", why); }, {});
  world.run_live({200, 0.2});
  double shown = 0;
  std::int64_t seen = -1;
  for (int i = 0; i < 4000 && seen < 64; ++i) {
    for (const ForceSample& s : world.force_trace("table", seen)) {
      shown = std::max(shown, std::hypot(s.force[0], s.force[1], s.force[2]));
      seen = s.step;
    }
    for (const ToolForce& f : world.tool_forces()) shown = std::max(shown, f.force[1]);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  world.stop_live();
  EXPECT_GE(seen, 64);
  EXPECT_GT(shown, 0);
  EXPECT_LE(shown, 10 * most) << "the first attempt comes to a hundred times that";
}

TEST(Trust, ATooFastDriveThroughTissueTakesMoreTime) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  ToolSpec ball;
  ball.name = "ball";
  ball.path = {{0, 0.05, 0.1, 0.03, 0, 0, 0, 1}};
  scene.tools = {ball};
  World world(scene, on("cpu"));
  EXPECT_EQ(code_of([&] { world.drive_tool("ball", {0.05, 0.06, 0.03}, {0, 0, 0, 1}, 1e-3); }), ErrorCode::input);
  world.run_live();
  world.drive_tool("ball", {0.05, 0.06, 0.03}, {0, 0, 0, 1}, 1e-3);
  bool slowed = false;
  for (int i = 0; i < 2000 && !slowed; ++i) {
    for (const Event& e : world.events()) {
      EXPECT_NE(e.kind, "refused") << e.text;
      if (e.kind != "slowed") continue;
      slowed = true;
      EXPECT_EQ(e.subject, "ball");
      EXPECT_GT(e.amount, 1e-3);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_TRUE(slowed);
  world.stop_live();
  world.advance(0.3);
  EXPECT_NEAR(world.tool_forces().front().position[1], 0.06, 1e-9);
}

/// A hand asks for the same place at every picture: that its tool is late is news only once.
TEST(Trust, TooFastDrivesInSuccessionAreToldOnce) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  ToolSpec ball;
  ball.name = "ball";
  ball.path = {{0, 0.05, 0.2, 0.03, 0, 0, 0, 1}};
  scene.tools = {ball};
  World world(scene, on("cpu"));
  world.run_live({100, 0.2});
  int told = 0, drives = 0;
  const auto listen = [&] {
    for (const Event& e : world.events()) told += e.kind == "slowed" ? 1 : 0;
  };
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 2000 && told < round; ++i, ++drives, listen()) {
      world.drive_tool("ball", {0.05, 0.05, 0.03}, {0, 0, 0, 1}, 1e-3);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    for (int i = 0; i < 10; ++i, listen()) {
      world.drive_tool("ball", {0.05, 0.05, 0.03}, {0, 0, 0, 1}, 1e-3);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(told, round);
    world.drive_tool("ball", {0.05, 0.2, 0.03}, {0, 0, 0, 1}, 1);  // slow enough
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace
}  // namespace pliant::trust_test
