// HapticLoop: a device drives a tool of a World and feels it, in wall time.
#include "pliant/haptics.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::block;
using test::code_of;
using test::message_of;
using test::on;
using Clock = std::chrono::steady_clock;

constexpr double kBlockTop = 0.08, kBallRadius = 0.015;

/// The soft block with a ball above the middle of its top.
SceneSpec block_and_ball() {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.bodies[0].material.damping = 30;
  ToolSpec ball;
  ball.name = "ball";
  ball.radius = kBallRadius;
  ball.path = {{0, 0.05, kBlockTop + kBallRadius + 0.002, 0.03, 0, 0, 0, 1}};
  scene.tools.push_back(ball);
  return scene;
}

/// A device whose tip goes down from its first place, by `depth` within `seconds` of the first read, and stays there. The loop
/// aligns the tool with the first sample, which a busy machine may read late.
class PressingDevice final : public HapticDevice {
 public:
  PressingDevice(double depth, double seconds) : depth_(depth), seconds_(seconds) {}
  DeviceSample read() noexcept override {
    const Clock::time_point now = Clock::now();
    if (number_ == 0) began_ = now;
    const double t = std::chrono::duration<double>(now - began_).count(), s = std::min(1.0, t / seconds_);
    DeviceSample sample;
    sample.position = {0, -depth_ * s * s * (3 - 2 * s), 0};
    sample.time = t;
    sample.number = ++number_;
    if (mad_) sample.position[2] = std::nan("");
    return sample;
  }
  void write(const DeviceWrench& wrench) noexcept override {
    if (!std::isfinite(wrench.force[1])) finite_ = false;
    if (wrench.force[1] > most_) most_ = wrench.force[1];
    last_ = wrench.force[1];
    answered_ = wrench.number;
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return limits_; }
  void set_limit(double newtons) { limits_.force = newtons; }
  /// Whether it says what is no position.
  void set_mad(bool mad) { mad_ = mad; }
  // For after the loop.
  [[nodiscard]] bool finite() const { return finite_; }
  [[nodiscard]] double most() const { return most_; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] std::uint64_t answered() const { return answered_; }  ///< number of the sample of the last write()

 private:
  double depth_, seconds_;
  Clock::time_point began_;
  std::uint64_t number_ = 0;
  std::atomic<double> most_{0}, last_{0};
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<bool> mad_{false}, finite_{true};
  DeviceLimits limits_;
};

/// Lets World and loop run for a while, with somebody who looks at the frames.
template <class Until>
bool run_until(World& world, double seconds, const Until& until) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    world.frame();
    if (until()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  return false;
}

double force_of(World& world) { return world.tool_forces().at(0).force[1]; }

HapticOptions with(const std::string& model) {
  HapticOptions options;
  options.model = model;
  return options;
}

TEST(Haptics, TheHandFeelsWhatTheSimulationFeels) {
  for (const char* model : {"buffer", "whole", "held", "extrapolated", "auto"}) {
    World world(block_and_ball(), on("cpu"));
    auto device = std::make_shared<PressingDevice>(0.012, 0.4);
    HapticLoop loop(world, "ball", device, with(model));
    world.run_live();
    const bool settled = run_until(world, 20, [&] {
      const HapticState now = loop.state();
      return now.last.time > 1.5 && now.frames > 60 && std::abs(now.last.force[1] - force_of(world)) < 0.05 * force_of(world);
    });
    const HapticState state = loop.state();
    EXPECT_TRUE(settled) << model << ": " << state.last.force[1] << " N at the hand, " << force_of(world) << " N on the tool, "
                         << state.frames << " frames, age " << state.age;
    EXPECT_GT(state.ticks, 300) << model;
    EXPECT_GT(state.last.force[1], 0.05) << model;
    if (std::string(model) != "auto") {
      EXPECT_EQ(state.model, model);
    }
    EXPECT_EQ(state.resets, 0) << model;
    EXPECT_EQ(state.not_finite, 0) << model;
    EXPECT_EQ(state.refused, 0) << model;
    EXPECT_GE(state.least_energy, 0) << model;
    world.stop_live();
  }
}

TEST(Haptics, ASimulationThatStallsLetsTheForceFadeOut) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.012, 0.2);
  HapticLoop loop(world, "ball", device);
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05 && loop.state().last.time > 0.6; }));
  world.stop_live();
  const std::int64_t ticks = loop.state().ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(900));
  const HapticState stalled = loop.state();
  EXPECT_EQ(stalled.last.force, (Vec3d{}));
  EXPECT_GT(stalled.ticks, ticks + 100);  // the loop goes on
  EXPECT_GT(stalled.stale, 0);
  world.run_live();
  EXPECT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05; }));
}

TEST(Haptics, ALoopOutlivesItsWorld) {
  auto device = std::make_shared<PressingDevice>(0.012, 0.2);
  auto world = std::make_unique<World>(block_and_ball(), on("cpu"));
  HapticLoop loop(*world, "ball", device);
  world->run_live();
  ASSERT_TRUE(run_until(*world, 20, [&] { return loop.state().last.force[1] > 0.05; }));
  world.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(900));
  EXPECT_EQ(loop.state().last.force, (Vec3d{}));
  EXPECT_TRUE(loop.state().running);
  loop.stop();
  EXPECT_FALSE(loop.state().running);
  EXPECT_EQ(device->last(), 0);
}

TEST(Haptics, TheForceStaysWithinTheLimits) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.014, 0.2);
  device->set_limit(0.1);
  HapticLoop loop(world, "ball", device);
  world.run_live();
  EXPECT_TRUE(run_until(world, 20, [&] { return loop.state().limited > 0; }));
  loop.stop();
  EXPECT_LE(device->most(), 0.1 * (1 + 1e-12));
}

TEST(Haptics, ADeviceThatWasMadIsFeltAgain) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.012, 0.2);
  HapticLoop loop(world, "ball", device);
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05 && loop.state().last.time > 0.4; }));
  device->set_mad(true);
  const std::int64_t ticks = loop.state().ticks;
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().ticks > ticks + 20; }));
  EXPECT_TRUE(std::isfinite(loop.state().last.position[2])) << "the last good place holds";
  device->set_mad(false);
  EXPECT_TRUE(run_until(world, 5, [&] { return loop.state().last.force[1] > 0.05; }));
  EXPECT_EQ(loop.state().refused, 0);
  loop.stop();
  EXPECT_TRUE(device->finite());
}

TEST(Haptics, ADeviceMayBeginMad) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.012, 1);
  device->set_mad(true);
  HapticLoop loop(world, "ball", device);
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().ticks > 20; }));
  device->set_mad(false);
  EXPECT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05; })) << loop.state().last.position[1];
}

TEST(Haptics, TwoDevicesDriveTwoTools) {
  SceneSpec scene = block_and_ball();
  scene.tools.push_back(scene.tools[0]);
  scene.tools[0].path[0][1] = 0.03;
  scene.tools[1].path[0][1] = 0.075;
  scene.tools[1].name = "second";
  scene.tools[0].radius = scene.tools[1].radius = kBallRadius;
  World world(scene, on("cpu"));
  auto one = std::make_shared<PressingDevice>(0.008, 0.2), two = std::make_shared<PressingDevice>(0.012, 0.2);
  HapticLoop first(world, "ball", one), second(world, "second", two);
  world.run_live();
  EXPECT_TRUE(run_until(world, 20, [&] {
    return first.state().last.time > 0.8 && first.state().last.force[1] > 0.02 &&
           second.state().last.force[1] > 1.2 * first.state().last.force[1];
  }));
  EXPECT_EQ(code_of([&] { HapticLoop third(world, "ball", one); }), ErrorCode::usage);
  first.stop();
  world.frame();
  HapticLoop again(world, "ball", one);  // the tool is free again
}

/// A device knows an answer by its number: devices behind a network drop those that answer nothing.
TEST(Haptics, TheLastForceIsZero) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.012, 0.2);
  HapticLoop loop(world, "ball", device);
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return device->last() > 0.05; }));
  loop.stop();
  EXPECT_EQ(device->last(), 0);
  EXPECT_GT(device->answered(), 0U);
}

TEST(Haptics, AParkedToolStaysParked) {
  World world(block_and_ball(), on("cpu"));
  HapticLoop loop(world, "ball", std::make_shared<PressingDevice>(0.012, 0.2));
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05; }));
  world.park_tool("ball");
  EXPECT_TRUE(run_until(world, 20, [&] { return world.tool_forces().at(0).parked && loop.state().last.force == Vec3d{}; }));
  EXPECT_FALSE(run_until(world, 0.3, [&] { return !world.tool_forces().at(0).parked; }));
  world.unpark_tool("ball");
  EXPECT_TRUE(run_until(world, 20, [&] { return loop.state().last.force[1] > 0.05; }));
}

TEST(Haptics, AfterAResetTheToolIsWhereTheDeviceIs) {
  World world(block_and_ball(), on("cpu"));
  HapticLoop loop(world, "ball", std::make_shared<PressingDevice>(0.012, 0.2));
  const double start = world.tool_forces().at(0).position[1];
  const auto pressed = [&] { return std::abs(world.tool_forces().at(0).position[1] - (start - 0.012)) < 1e-4; };
  world.run_live();
  ASSERT_TRUE(run_until(world, 20, [&] { return loop.state().last.time > 0.5 && pressed(); }));
  world.stop_live();
  world.reset();
  ASSERT_NEAR(world.tool_forces().at(0).position[1], start, 1e-9);
  world.run_live();
  EXPECT_TRUE(run_until(world, 20, pressed));  // the device has not moved meanwhile
}

/// A scalpel in the hand: it feels the tissue, cuts it, and is where the hand takes it.
TEST(Haptics, AHandHoldsABlade) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.bodies[0].material.damping = 30;
  scene.bodies[0].material.toughness = 5000;
  BladeSpec blade;
  blade.name = "scalpel";
  blade.cuts = "by-force";
  blade.edge = 0.0005;
  blade.path = {{0, 0.053, kBlockTop + 0.001, -0.01, 0.053, kBlockTop + 0.001, 0.07}};
  scene.blades.push_back(blade);
  World world(scene, on("cpu"));
  EXPECT_EQ(message_of([&] { HapticLoop loop(world, "knife", std::make_shared<PressingDevice>(0.01, 1)); }),
            "haptics: there is no tool or blade by force \"knife\"; there are \"scalpel\"");
  auto device = std::make_shared<PressingDevice>(0.02, 1);
  HapticLoop loop(world, "scalpel", device, with("buffer"));
  world.run_live();
  EXPECT_TRUE(run_until(world, 20, [&] {
    const BladeForce now = world.blade_forces().at(0);
    return loop.state().last.time > 1.2 && now.gave_way >= 0 && std::abs(now.a[1] - (kBlockTop - 0.019)) < 1e-4;
  }));
  EXPECT_GT(device->most(), 0.1);
  EXPECT_TRUE(device->finite());
  const HapticState state = loop.state();
  EXPECT_EQ(state.model, "buffer");
  EXPECT_GT(state.elements, 0);
  EXPECT_EQ(state.refused, 0);
  EXPECT_EQ(state.resets, 0);
  world.lift_blade("scalpel");
  EXPECT_TRUE(run_until(world, 20, [&] { return !world.blade_forces().at(0).present && loop.state().last.force == Vec3d{}; }));
  EXPECT_EQ(message_of([&] { HapticLoop second(world, "scalpel", std::make_shared<PressingDevice>(0.01, 1)); }),
            "haptics: blade \"scalpel\" is nowhere at present; drive_blade() places it first");
}

TEST(Haptics, WrongOptionsAreRefused) {
  World world(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.01, 1);
  const auto refused = [&](auto&& change) {
    HapticOptions options;
    change(options);
    EXPECT_EQ(code_of([&] { HapticLoop loop(world, "ball", device, options); }), ErrorCode::usage);
    return message_of([&] { HapticLoop loop(world, "ball", device, options); });
  };
  EXPECT_EQ(refused([](HapticOptions& o) { o.rate = 100; }), "haptics: rate is 100, expected 300 to 10000");
  EXPECT_EQ(refused([](HapticOptions& o) { o.model = "spring"; }),
            "haptics: model is \"spring\", expected auto, buffer, whole, held or extrapolated");
  EXPECT_EQ(refused([](HapticOptions& o) { o.stiffness = std::nan(""); }), "haptics: stiffness is nan, expected 0 to 1000000");
  EXPECT_EQ(message_of([&] { HapticLoop loop(world, "rod", device); }),
            "haptics: there is no tool or blade by force \"rod\"; there are \"ball\"");
  EXPECT_EQ(message_of([&] { HapticLoop loop(world, "ball", nullptr); }), "haptics: the device is null");
  world.park_tool("ball");
  EXPECT_EQ(message_of([&] { HapticLoop loop(world, "ball", device); }), "haptics: tool \"ball\" is parked; unpark it first");
}

TEST(Haptics, ADeviceDrivesOneLoopWithinItsLimits) {
  World world(block_and_ball(), on("cpu")), other(block_and_ball(), on("cpu"));
  auto device = std::make_shared<PressingDevice>(0.01, 1);
  device->set_limit(-1);
  EXPECT_EQ(message_of([&] { HapticLoop loop(world, "ball", device); }),
            "haptic device: its limits are -1 N and inf N m, expected 0 or more");
  device->set_limit(std::nan(""));
  EXPECT_EQ(code_of([&] { HapticLoop loop(world, "ball", device); }), ErrorCode::usage);
  device->set_limit(5);
  HapticLoop loop(world, "ball", device);
  EXPECT_EQ(message_of([&] { HapticLoop second(other, "ball", device); }),
            "haptics: this device drives another loop; stop() that one first, or open the device again");
  loop.stop();
  HapticLoop second(other, "ball", device);
}

TEST(Haptics, WhatTheDeviceSaidPlaysAgain) {
  const test::TempFolder folder;
  World world(block_and_ball(), on("cpu"));
  HapticOptions options;
  options.log_samples = 5000;
  HapticLoop loop(world, "ball", std::make_shared<PressingDevice>(0.01, 0.2), options);
  world.run_live();
  run_until(world, 20, [&] { return loop.state().ticks > 400; });
  loop.stop();
  const std::string file = folder.path() / "stroke.csv";
  loop.write_log(file);
  const auto played = open_haptic_device("file:" + file);
  EXPECT_GT(played->read().number, 0);
  HapticLoop none(world, "ball", played);
  EXPECT_EQ(code_of([&] { none.write_log(file); }), ErrorCode::state);
}

}  // namespace
}  // namespace pliant
