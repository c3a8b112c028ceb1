// Cuts, saves and resets of a World that runs freely: what is built beside the steps is there when it is asked for.
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
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

TEST(LiveEdits, ASavedStateHasAllCutsBeforeIt) {
  const test::TempFolder folder;
  for (int i = 0; i < 10; ++i) {
    const std::string file = (folder.path() / (std::to_string(i) + ".pck")).string();
    World world(resting_block(), on("cpu", true)), other(resting_block(), on("cpu", true));
    Told told(world);
    world.run_live();
    until_frames(world, 2);
    world.cut(kThrough);
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * i));
    world.cut({{{{0.05, -1, -1}, {0.05, -1, 3}, {0.05, 3, -1}}}});  // while the first is built, or before
    world.save(file);
    told.wait_for("saved");
    other.load(file);
    EXPECT_EQ(other.pieces(0), 4) << i;
  }
}

TEST(LiveEdits, TheFocusAfterALoadIsThatOfTheStateThatComes) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  World world(resting_block(), on("cpu"));
  Told told(world);
  world.save(file);
  world.run_live();
  until_frames(world, 2);
  world.load(file);
  world.move_focus({0.01, 0.02, 0.03});
  told.wait_for("loaded");
  until_frames(world, 2);
  EXPECT_EQ(WorldAccess::simulation(world).state().focus, (Vec3d{0.01, 0.02, 0.03}));
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

/// A program that asks for anything, at any time.
class Restless {
 public:
  Restless(World& world, std::string file, unsigned seed) : world_(world), file_(std::move(file)), random_(seed) {}

  void act() {
    try {
      acts_[static_cast<std::size_t>(share() * static_cast<double>(acts_.size()))]();
    } catch (const Error& error) {  // of another state than it takes; not of the device, nor of Pliant
      EXPECT_NE(error.code(), ErrorCode::device) << error.what();
      EXPECT_NE(error.code(), ErrorCode::internal) << error.what();
    }
    if (world_.poll()) look(*world_.frame());
  }

 private:
  double share() { return std::uniform_real_distribution<double>(0, 0.999999)(random_); }
  Vec3d place(double above) { return {0.1 * share(), 0.08 * share() + above, 0.06 * share()}; }
  static void look(const Frame& frame) {
    ASSERT_EQ(frame.positions.size(), frame.rest.size());
    for (const auto& t : frame.triangles) {
      for (const std::int32_t v : t) ASSERT_LT(static_cast<std::size_t>(v), frame.positions.size());
    }
  }
  void slice() {
    const double y = 0.02 + 0.05 * share();
    world_.cut({{{{-1, y, -1}, {-1, y + 0.01, 3}, {3, y, -1}}}});
  }
  void hold() {
    if (grab_ != 0) world_.release(std::exchange(grab_, 0));
    if (const auto hit = world_.pick({0.05, 1, 0.03}, {0, -1, 0})) grab_ = world_.grab(hit->vertex);
  }
  void soften() {
    ChangeSpec change;
    change.gravity = Vec3d{0, -9.81 * share(), 0};
    if (share() < 0.5) {
      change.body = "block";
      change.material = block().bodies[0].material;
      change.material->young = 2000 + 2000 * share();
    }
    world_.change(change);
  }
  void stop() {
    world_.stop_live();
    world_.step(5);
    world_.run_live();
  }

  World& world_;
  std::string file_;
  std::mt19937 random_;
  GrabId grab_ = 0;
  double height_ = 0.12;
  const std::vector<std::function<void()>> acts_{
      [this] { slice(); },
      [this] {
        world_.move_blade("knife", {0.1 * share(), -0.1, -1}, {0.1 * share(), -0.1 + 0.2 * share(), 1});
      },
      [this] { world_.lift_blade("knife"); },
      [this] {
        world_.drive_tool("probe", {0.05, height_ = 0.09 + 0.04 * share(), 0.03}, {0, 0, 0, 1}, 0.05);
      },
      [this] { world_.park_tool("probe"); },
      [this] { world_.unpark_tool("probe"); },
      [this] { hold(); },
      [this] {
        if (grab_ != 0) world_.move_grab(grab_, place(0.02));
      },
      [this] { soften(); },
      [this] { world_.save(file_); },
      [this] { world_.load(file_); },
      [this] { world_.reset(); },
      [this] { world_.recover(); },
      [this] { stop(); },
      [this] { static_cast<void>(world_.hash()); },
      [this] { static_cast<void>(world_.probes()); },
      [this] { EXPECT_EQ(world_.displacements(0).size(), world_.rest_positions(0).size()); },
      [this] { EXPECT_GE(world_.pieces(0), 1); },
      [this] { static_cast<void>(world_.events()); },
  };
};

TEST(LiveEdits, AnyCallAtAnyTimeFindsAWholeWorld) {
  const test::TempFolder folder;
  for (unsigned seed = 0; seed < 6; ++seed) {
    SceneSpec scene = block(0);
    if (seed % 2 == 1) {
      scene.bodies[0].model.type = "hybrid";
      scene.bodies[0].model.ratio = 0.4;
      scene.bodies[0].model.follow = "probe";
    }
    ProbeSpec probe;
    probe.name = "tip";
    probe.point = Vec3d{0.1, 0.08, 0.06};
    scene.probes.push_back(probe);
    if (seed % 3 == 2) {  // a blade of the scene that goes to and fro
      BladeSpec blade;
      blade.name = "scalpel";
      for (int k = 0; k < 20; ++k)
        blade.path.push_back({0.1 * k, 0.03 + 0.002 * k, k % 2 * 0.1, -1, 0.03 + 0.002 * k, k % 2 * 0.1, 1});
      scene.blades.push_back(blade);
      scene.break_stretch = 1.3;
    }
    ToolSpec tool = {};
    tool.name = "probe";
    tool.radius = 0.01;
    tool.path = {{0, 0.05, 0.12, 0.03, 0, 0, 0, 1}};
    scene.tools.push_back(tool);
    World world(scene, {"cpu", 0, true, true, true});
    world.run_live();
    Restless program(world, (folder.path() / (std::to_string(seed) + ".pck")).string(), seed);
    for (int i = 0; i < 150; ++i) {
      program.act();
      if (i % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    world.recover();
    world.stop_live();
    world.reset();
    EXPECT_EQ(world.step(20).done, 20);
    EXPECT_GE(world.pieces(0), 1);
  }
}

}  // namespace
}  // namespace pliant
