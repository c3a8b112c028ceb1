// Wrong calls, bad input and lost devices: an Error with the right code, and the last good state.
#include <cmath>
#include <thread>

#include "scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using test::block;
using test::code_of;
using test::message_of;
using test::on;

TEST(Misuse, InputIsRefusedWithItsPlace) {
  SceneSpec scene = block();
  scene.bodies[0].material.young = -3;
  EXPECT_EQ(code_of([&] { World{scene}; }), ErrorCode::input);
  EXPECT_NE(message_of([&] { World{scene}; }).find("/bodies/0/material/young"), std::string::npos);
  scene = block();
  scene.bodies[0].surface.triangles[3][1] = 8;
  EXPECT_EQ(code_of([&] { World{scene}; }), ErrorCode::input);
  EXPECT_NE(message_of([&] { World{scene}; }).find("memory:0': triangle 3 names vertex 8"), std::string::npos);
  scene.bodies[0].surface_file = "both.obj";
  EXPECT_EQ(code_of([&] { World{scene}; }), ErrorCode::input);
  EXPECT_EQ(code_of([&] { World{SceneSpec{}}; }), ErrorCode::input);
  EXPECT_EQ(code_of([&] { World::parse("{"); }), ErrorCode::input);
}

TEST(Misuse, FilesThatAreMissingAreIo) {
  EXPECT_EQ(code_of([] { World::open("no/such/scene.json"); }), ErrorCode::io);
  SceneSpec scene = block();
  scene.bodies[0].surface = {};
  scene.bodies[0].surface_file = "no/such/mesh.obj";
  EXPECT_EQ(code_of([&] { World{scene}; }), ErrorCode::io);
  World world(block(), on("cpu"));
  EXPECT_EQ(code_of([&] { world.load("no/such/state"); }), ErrorCode::io);
  EXPECT_EQ(code_of([&] { world.save("no/such/folder/state"); }), ErrorCode::io);
  EXPECT_EQ(world.step(3).step, 3);
}

TEST(Misuse, BackendsThatDoNotExistAreDevices) {
  EXPECT_EQ(code_of([] { World(block(), on("opencl:99")); }), ErrorCode::device);
  EXPECT_EQ(code_of([] { World(block(), on("abacus")); }), ErrorCode::device);
}

TEST(Misuse, CallsThatMakeNoSense) {
  World world(block(), on("cpu"));
  EXPECT_EQ(code_of([&] { world.step(-1); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.advance(-1); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.step_async(-1); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { (void)world.displacements(1); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.move_focus({0, std::nan(""), 0}); }), ErrorCode::usage);
  WorldOptions options;
  options.dt = -1;
  EXPECT_EQ(code_of([&] { World(block(), options); }), ErrorCode::usage);
  const World taken = std::move(world);
  EXPECT_EQ(code_of([&] { world.step(); }), ErrorCode::state);  // NOLINT: that is what is tested
  EXPECT_FALSE(world.poll());
  EXPECT_EQ(taken.step_number(), 0);
}

TEST(Misuse, TwoThreadsAtOnceAreRefused) {
  World world(block(), on("cpu"));
  std::atomic<bool> done{false}, refused{false};  // whichever thread comes second
  const auto tried = [&](const auto& call) {
    try {
      call();
      return true;
    } catch (const Error& error) {
      refused = refused || error.code() == ErrorCode::state;
      return false;
    }
  };
  std::thread other([&] {
    while (!tried([&] { world.step(20000); })) continue;
    done = true;
  });
  while (!done && !refused) tried([&] { (void)world.time(); });
  other.join();
  EXPECT_TRUE(refused);
}

TEST(Misuse, SteppingAfterDivergenceKeepsTheLastGoodState) {
  World world(test::unstable(), on("cpu"));
  StepReport report;
  for (int i = 0; i < 1000 && !report.diverged; ++i) report = world.step(10);
  ASSERT_TRUE(report.diverged);
  EXPECT_NE(report.message.find("block"), std::string::npos);
  const FramePtr frame = world.frame();
  EXPECT_EQ(frame->step, report.step);
  for (const Vec4f& x : frame->positions) EXPECT_TRUE(std::isfinite(x[0] + x[1] + x[2]));
  EXPECT_EQ(code_of([&] { world.step(); }), ErrorCode::diverged);
  EXPECT_EQ(code_of([&] { world.step_async(1); }), ErrorCode::diverged);
  EXPECT_EQ(world.frame(), frame);
  world.reset();
  EXPECT_EQ(world.step(1).step, 1);
}

/// A world whose device is lost after so many launches.
struct Losing {
  std::shared_ptr<std::atomic<int>> left = std::make_shared<std::atomic<int>>(1 << 30);
  World world = WorldAccess::make(scene(), [left = left](std::string*, std::int64_t) -> std::unique_ptr<Backend> {
    return std::make_unique<test::FaultyBackend>(open_backend("cpu"), left);
  });
  static Scene scene() {
    return parse_scene(R"({"format": "pliant-scene/1", "bodies": [{"name": "cube", "surface": ")" + test::source_dir() +
                           R"(/scenes/meshes/cube.obj", "lattice": {"spacing": 0.02},
      "material": {"young": 3000, "poisson": 0.4}, "velocity": [1, 0, 0]}]})",
                       "");
  }
};

TEST(Misuse, ALostDeviceLeavesTheLastFrame) {
  Losing losing;
  World& world = losing.world;
  world.step(50);
  const FramePtr frame = world.frame();
  *losing.left = 1;
  EXPECT_EQ(code_of([&] { world.step(500); }), ErrorCode::device);
  EXPECT_EQ(world.frame(), frame);
  EXPECT_GT(frame->positions[0][0] - frame->rest[0][0], 0);
  EXPECT_EQ(code_of([&] { world.step(1); }), ErrorCode::device);
  EXPECT_EQ(code_of([&] { (void)world.displacements(0); }), ErrorCode::device);
  EXPECT_EQ(code_of([&] { world.save("state"); }), ErrorCode::device);
  *losing.left = 1 << 30;  // it is back
  world.reset();
  EXPECT_EQ(world.step(50).step, 50);
  EXPECT_EQ(world.frame()->positions[0], frame->positions[0]);
}

TEST(Misuse, TheWorkerTellsOnceWhatItMet) {
  Losing losing;
  World& world = losing.world;
  *losing.left = 3;
  ASSERT_TRUE(world.step_async(500));
  EXPECT_EQ(code_of([&] { world.wait(); }), ErrorCode::device);
  EXPECT_NO_THROW(world.wait());
  EXPECT_EQ(code_of([&] { world.step_async(1); }), ErrorCode::device);
  EXPECT_EQ(world.frame()->step, 0);
}

TEST(Misuse, ADeviceLostWhileAFrameIsReadLeavesTheFrameBefore) {
  Losing losing;
  World& world = losing.world;
  const FramePtr before = world.frame();
  world.step(10);
  *losing.left = 0;
  EXPECT_EQ(code_of([&] { world.frame(); }), ErrorCode::device);
  EXPECT_EQ(world.frame(), before);
}

}  // namespace
}  // namespace pliant
