// Cuts, saves and resets of a World that runs freely: what is built beside the steps is there when it is asked for.
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "live.h"
#include "scene/spec.h"
#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using namespace live_test;
using test::block;
using test::on;

/// A block that stays where it is, and what cuts it in two.
SceneSpec resting_block() {
  SceneSpec scene = block(0);
  scene.gravity = {};
  return scene;
}
const std::vector<std::array<Vec3d, 3>> kThrough{{{{-1, 0.045, -1}, {-1, 0.045, 3}, {3, 0.045, -1}}}};

TEST(LiveEdits, ASavedStateHasTheCutBeforeIt) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "cut.pck").string();
  World world(resting_block(), on("cpu", true)), other(resting_block(), on("cpu", true));
  Told told(world);
  world.run_live();
  until_frames(world, 3);
  world.cut(kThrough);
  world.save(file);
  told.wait_for("saved");
  other.load(file);
  EXPECT_EQ(other.pieces(0), 2);
}

TEST(LiveEdits, ACutIsMadeWhereverTheWorldIsStopped) {
  for (int i = 0; i < 12; ++i) {
    World world(resting_block(), on("cpu", true));
    world.run_live();
    until_frames(world, 2);
    world.cut(kThrough);
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * i));
    world.stop_live();
    EXPECT_EQ(world.displacements(0).size(), world.rest_positions(0).size());
    world.step(1);
    EXPECT_EQ(world.pieces(0), 2) << i;
    EXPECT_TRUE(world.cut({{{{0.05, -1, -1}, {0.05, -1, 3}, {0.05, 3, -1}}}}).changed);  // now, not beside the steps
    EXPECT_EQ(world.pieces(0), 4) << i;
  }
}

TEST(LiveEdits, FramesGoOnUntilAResetHasMadeItsSimulation) {
  std::promise<void> made;
  const std::shared_future<void> may_open = made.get_future().share();
  int opened = 0;
  const OpenBackend open = [&](std::string*, std::int64_t) {
    if (opened++ > 0) may_open.wait();
    return open_backend("cpu");
  };
  World world = WorldAccess::make(scene_of(resting_block()), open, on("cpu"));
  Told told(world);
  world.run_live();
  until_frames(world, 3);
  const std::int64_t before = world.step_number();
  world.reset();
  until_frames(world, 5);
  EXPECT_GT(world.step_number(), before);
  made.set_value();
  EXPECT_EQ(told.wait_for("reset").step, 0);
  until_frames(world, 3);
}

}  // namespace
}  // namespace pliant
