// A run by hand in lockstep, and the same drives by the calls of a World: one hash.
#include <gtest/gtest.h>

#include <cmath>

#include "devices/stroke_device.h"
#include "haptics/lockstep.h"
#include "scenes.h"
#include "support/source_dir.h"

namespace pliant::replay_test {
namespace {

std::string cube_and_ball() {
  return R"({"format": "pliant-scene/1", "duration": 2, "gravity": [0, 0, 0], "bodies": [{"name": "cube",
    "surface": ")" +
         test::source_dir() + R"(/scenes/meshes/cube.obj", "lattice": {"spacing": 0.02}, "element": "hex8",
    "material": {"law": "neo-hookean", "young": 5000, "poisson": 0.4, "density": 1000, "damping": 20},
    "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}]}],
    "tools": [{"name": "ball", "shape": {"sphere": 0.015}, "path": [[0, 0, 0.067, 0]]}]})";
}

TEST(Replay, AWorldThatIsDrivenAlikeHasTheSameHash) {
  std::vector<DeviceSample> stroke;
  for (int k = 0; k <= 60; ++k) {
    DeviceSample s;
    s.time = k / 512.0;
    s.position = {0, -0.012 * std::sin(k / 20.0), 0};
    s.number = static_cast<std::uint64_t>(k) + 1;
    stroke.push_back(s);
  }
  Simulation s(parse_scene(cube_and_ball(), "scene.json"), open_backend("cpu"));
  haptics::DriveLog log;
  haptics::Lockstep lockstep(s, {{"ball", std::make_shared<devices::StrokeDevice>(stroke)}}, {.stop = {}, .remark = {}}, log);
  for (bool on = true; on;) {
    const std::int64_t left = lockstep.steps_left(s);
    if (left > 0) {
      s.advance(s.next_batch(left));
    } else {
      on = lockstep.next(s);
    }
  }
  ASSERT_EQ(log.drives.size(), 60U);
  World world = World::parse(cube_and_ball(), "", test::on("cpu"));
  for (const haptics::LoggedDrive& d : log.drives) {
    world.step(d.at.step - world.step_number());
    world.drive_tool(d.tool, d.target.position, d.target.turn, d.seconds);
  }
  world.step(s.step() - world.step_number());
  EXPECT_EQ(world.hash(), s.hash());
  EXPECT_GT(lockstep.counts(0).largest_force, 0.01);
}

}  // namespace
}  // namespace pliant::replay_test
