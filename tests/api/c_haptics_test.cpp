// Touch in the C API: devices by text, by callbacks and by hand, and loops of them.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "c_struct_checks.h"
#include "c_world.h"
#include "pliant/haptics.h"
#include "support/temp_folder.h"

namespace pliant::c_haptics_test {
namespace {

using test::CCube;
using test::expect_checked;
using test::Later;
using Clock = std::chrono::steady_clock;

constexpr double kRest[4]{0, 0, 0, 1};

/// The cube with a ball 1 mm above its top, and a device.
class CHaptics : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const ball = R"({"name": "ball", "shape": {"sphere": 0.01}, "path": [[0, 0.02, 0.02, 0.051]]})";
    ASSERT_EQ(pliant_world_parse_tool(world, ball, nullptr, nullptr, 0), PLIANT_OK) << pliant_last_error();
    ASSERT_EQ(pliant_manual_device_create(nullptr, &device), PLIANT_OK) << pliant_last_error();
    options.realtime = 0;
  }
  void TearDown() override {
    pliant_haptic_loop_destroy(loop);
    pliant_haptic_device_destroy(device);
  }
  void start(pliant_haptic_device by) {
    ASSERT_EQ(pliant_haptic_loop_create(world, "ball", by, &options, &loop), PLIANT_OK) << pliant_last_error();
    ASSERT_EQ(pliant_world_run_live(world, nullptr), PLIANT_OK) << pliant_last_error();
  }
  void put(double height) const {
    const double at[3]{0, 0, height};
    ASSERT_EQ(pliant_manual_device_set_pose(device, at, kRest, 0), PLIANT_OK) << pliant_last_error();
  }
  [[nodiscard]] pliant_haptic_sample last() const {
    pliant_haptic_sample sample = PLIANT_HAPTIC_SAMPLE_INIT;
    EXPECT_EQ(pliant_haptic_loop_state(loop, nullptr, &sample), PLIANT_OK) << pliant_last_error();
    return sample;
  }
  [[nodiscard]] pliant_haptic_state state() const {
    pliant_haptic_state now = PLIANT_HAPTIC_STATE_INIT;
    EXPECT_EQ(pliant_haptic_loop_state(loop, &now, nullptr), PLIANT_OK) << pliant_last_error();
    return now;
  }
  /// Waits for 20 s at most, with somebody who looks at the frames.
  template <class Until>
  bool wait_for(const Until& until) const {
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end;) {
      pliant_frame frame = PLIANT_FRAME_INIT;
      pliant_world_frame(world, &frame);
      if (until()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    return false;
  }
  /// Presses the ball 4 mm into the cube within 0.2 s.
  void press() const {
    for (int i = 0; i <= 50; ++i) {
      put(-0.005 * i / 50);
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  }

  CCube world;
  pliant_haptic_device device{0};
  pliant_haptic_options options = PLIANT_HAPTIC_OPTIONS_INIT;
  pliant_haptic_loop loop{0};
};

TEST_F(CHaptics, AHandOfTheProgramFeelsTheCube) {
  put(0);
  start(device);
  EXPECT_TRUE(wait_for([&] { return state().frames > 2; }));
  EXPECT_EQ(last().force[2], 0) << "it is above the cube";
  press();
  pliant_device_wrench felt = PLIANT_DEVICE_WRENCH_INIT;
  EXPECT_TRUE(wait_for([&] {
    EXPECT_EQ(pliant_manual_device_wrench(device, &felt), PLIANT_OK);
    return felt.force[2] > 0.01 && state().elements > 0;
  }));
  EXPECT_EQ(felt.number, 52U);
  EXPECT_GT(felt.time, 0);
  const pliant_haptic_sample now = last();
  EXPECT_NEAR(now.device[2], 0.046, 1e-12) << "the device began where the tool was";
  EXPECT_NEAR(now.position[0], 0.02, 1e-12);
  EXPECT_GT(now.tissue[2], 0.01);
  EXPECT_EQ(state().running, 1);
  EXPECT_STREQ(state().model, "buffer");
  ASSERT_EQ(pliant_haptic_loop_stop(loop), PLIANT_OK);
  ASSERT_EQ(pliant_manual_device_wrench(device, &felt), PLIANT_OK);
  EXPECT_EQ(felt.force[2], 0);
  EXPECT_EQ(state().running, 0);
  EXPECT_GT(state().ticks, 0);
}

TEST_F(CHaptics, EachTickIsGivenOnce) {
  put(0);
  start(device);
  std::int64_t next = 1;
  EXPECT_TRUE(wait_for([&] {
    std::vector<Later<pliant_haptic_sample>> some(7);  // elements of a later version
    for (auto& s : some) s.known.size = sizeof some[0];
    std::size_t given = 99;
    EXPECT_EQ(pliant_haptic_loop_samples(loop, &some[0].known, some.size(), &given), PLIANT_OK) << pliant_last_error();
    for (std::size_t i = 0; i < given; ++i) EXPECT_EQ(some[i].known.tick, next++);
    return next > 60;
  }));
  pliant_haptic_loop_stop(loop);
  std::vector<pliant_haptic_sample> rest(100000, pliant_haptic_sample PLIANT_HAPTIC_SAMPLE_INIT);
  std::size_t given = 0;
  ASSERT_EQ(pliant_haptic_loop_samples(loop, rest.data(), rest.size(), &given), PLIANT_OK);
  EXPECT_EQ(next - 1 + static_cast<std::int64_t>(given), state().ticks);
  EXPECT_NEAR(rest[0].device[2], 0.051, 1e-12);
  ASSERT_EQ(pliant_haptic_loop_samples(loop, rest.data(), rest.size(), &given), PLIANT_OK);
  EXPECT_EQ(given, 0U);
}

/// What a device of callbacks says and hears.
struct Hand {
  std::atomic<double> height{0};
  std::atomic<std::uint64_t> number{0};
  std::atomic<double> most{0};
  std::atomic<int> released{0};
  pliant_device_callbacks callbacks{sizeof(pliant_device_callbacks), this, read, write, release};

  void put(double z) {
    height = z;
    ++number;
  }
  static void read(void* user, pliant_device_sample* sample) {
    const auto* const hand = static_cast<Hand*>(user);
    EXPECT_EQ(sample->size, sizeof *sample);
    EXPECT_NEAR(sample->turn[3], 1, 0) << "nothing need be said of a turn that never changes";
    sample->number = hand->number;
    sample->position[2] = hand->height;
    // A program with later headers knows members that this library does not.
    reinterpret_cast<Later<pliant_device_sample>*>(sample)->more[23] = 1;
  }
  static void write(void* user, const pliant_device_wrench* wrench) {
    auto* const hand = static_cast<Hand*>(user);
    EXPECT_EQ(reinterpret_cast<const Later<pliant_device_wrench>*>(wrench)->more[23], 0);
    if (std::abs(wrench->force[2]) > hand->most) hand->most = std::abs(wrench->force[2]);
  }
  static void release(void* user) { ++static_cast<Hand*>(user)->released; }
};

TEST_F(CHaptics, CallbacksAreADevice) {
  Hand hand;
  pliant_device_limits limits = PLIANT_DEVICE_LIMITS_INIT;
  limits.force = 0.005;
  pliant_haptic_device own{0};
  ASSERT_EQ(pliant_haptic_device_create(&hand.callbacks, &limits, &own), PLIANT_OK) << pliant_last_error();
  pliant_device_limits told = PLIANT_DEVICE_LIMITS_INIT;
  ASSERT_EQ(pliant_haptic_device_limits(own, &told), PLIANT_OK);
  EXPECT_EQ(told.force, 0.005);
  EXPECT_TRUE(std::isinf(told.torque));
  hand.put(0);
  start(own);
  EXPECT_TRUE(wait_for([&] { return last().device[2] > 0.05; }));
  for (int i = 0; i <= 50; ++i) {
    hand.put(-0.005 * i / 50);
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  EXPECT_TRUE(wait_for([&] { return state().limited > 0 && hand.most > 0.004; }));
  EXPECT_LE(hand.most, 0.005 * (1 + 1e-12));
  pliant_device_counts counts = PLIANT_DEVICE_COUNTS_INIT;
  ASSERT_EQ(pliant_haptic_device_counts(own, &counts), PLIANT_OK);
  EXPECT_GT(counts.received, 2U);
  EXPECT_EQ(counts.refused, 0U);
  EXPECT_STREQ(counts.last_refusal, "");
  hand.put(std::nan(""));
  EXPECT_TRUE(wait_for([&] { return pliant_haptic_device_counts(own, &counts) == PLIANT_OK && counts.refused > 0; }));
  EXPECT_STREQ(counts.last_refusal, "a position that is not finite");
  EXPECT_EQ(counts.refused, 1U) << "once, not in every tick";
  EXPECT_NEAR(last().device[2], 0.046, 1e-12) << "the last good one holds";
  ASSERT_EQ(pliant_haptic_device_destroy(own), PLIANT_OK);
  EXPECT_EQ(pliant_haptic_device_counts(own, &counts), PLIANT_STATE);
  EXPECT_EQ(hand.released, 0) << "the loop needs it";
  ASSERT_EQ(pliant_haptic_loop_destroy(loop), PLIANT_OK);
  EXPECT_EQ(hand.released, 1);
}

TEST_F(CHaptics, OptionsArrive) {
  const HapticOptions cpp;
  const pliant_haptic_options c = PLIANT_HAPTIC_OPTIONS_INIT;
  EXPECT_EQ(c.rate, cpp.rate);
  EXPECT_EQ(c.rings, cpp.rings);
  EXPECT_EQ(c.share, cpp.share);
  EXPECT_EQ(c.predict, cpp.predict);
  EXPECT_EQ(c.lead, cpp.lead);
  EXPECT_EQ(c.stiffness + c.damping + c.turn_stiffness + c.turn_damping,
            cpp.stiffness + cpp.damping + cpp.turn_stiffness + cpp.turn_damping);
  EXPECT_EQ(c.passive != 0, cpp.passive);
  EXPECT_EQ(c.device_damping, cpp.device_damping);
  EXPECT_EQ(c.stale_after, cpp.stale_after);
  EXPECT_EQ(c.ramp, cpp.ramp);
  EXPECT_EQ(c.greatest_force + c.greatest_torque, cpp.greatest_force + cpp.greatest_torque);
  EXPECT_EQ(c.align != 0, cpp.align);
  EXPECT_EQ(c.motion_scale, cpp.motion_scale);
  EXPECT_EQ(c.force_scale, cpp.force_scale);
  EXPECT_EQ(c.realtime != 0, cpp.realtime);
  EXPECT_EQ(c.log_samples, cpp.log_samples);
  EXPECT_EQ(c.grip_button, cpp.grip_button);
  options.align = 0;
  options.model = "held";
  const double at[3]{0.02, 0.02, 0.07};
  ASSERT_EQ(pliant_manual_device_set_pose(device, at, kRest, 0), PLIANT_OK);
  start(device);
  EXPECT_TRUE(wait_for([&] { return state().ticks > 3; }));
  EXPECT_NEAR(last().position[2], 0.07, 1e-12) << "the device speaks in scene coordinates";
  EXPECT_STREQ(state().model, "held");
}

/// Each option that has a range is refused by its name, and so is none mistaken for another.
TEST_F(CHaptics, EveryOptionIsTheOneOfItsName) {
  using Options = pliant_haptic_options;
  const std::pair<double Options::*, const char*> numbers[] = {{&Options::rate, "rate"},
                                                               {&Options::share, "share"},
                                                               {&Options::predict, "predict"},
                                                               {&Options::lead, "lead"},
                                                               {&Options::stiffness, "stiffness"},
                                                               {&Options::damping, "damping"},
                                                               {&Options::turn_stiffness, "turn_stiffness"},
                                                               {&Options::turn_damping, "turn_damping"},
                                                               {&Options::device_damping, "device_damping"},
                                                               {&Options::stale_after, "stale_after"},
                                                               {&Options::ramp, "ramp"},
                                                               {&Options::greatest_force, "greatest_force"},
                                                               {&Options::greatest_torque, "greatest_torque"},
                                                               {&Options::motion_scale, "motion_scale"},
                                                               {&Options::force_scale, "force_scale"}};
  const auto refused = [&](const Options& wrong, const std::string& name) {
    EXPECT_EQ(pliant_haptic_loop_create(world, "ball", device, &wrong, &loop), PLIANT_USAGE) << name;
    EXPECT_EQ(std::string(pliant_last_error()).rfind("haptics: " + name + " is ", 0), 0U) << pliant_last_error();
    EXPECT_EQ(loop.id, 0U);
  };
  for (const auto& [member, name] : numbers) {
    Options wrong = options;
    wrong.*member = -1;
    refused(wrong, name);
  }
  Options wrong = options;
  wrong.rings = 0;
  refused(wrong, "rings");
  wrong = options;
  wrong.log_samples = 200000000;
  refused(wrong, "log_samples");
  wrong = PLIANT_HAPTIC_OPTIONS_INIT;
  wrong.grip_button = 32;
  refused(wrong, "grip_button");
  wrong = options;
  wrong.model = "spring";
  refused(wrong, "model");
}

TEST_F(CHaptics, DevicesByTextAndTheLog) {
  const test::TempFolder folder;
  options.log_samples = 100;
  put(0);
  start(device);
  EXPECT_TRUE(wait_for([&] { return state().ticks > 3; }));
  pliant_haptic_loop_stop(loop);
  const std::string file = folder.path() / "stroke.csv", text = "file:" + file;
  ASSERT_EQ(pliant_haptic_loop_write_log(loop, file.c_str()), PLIANT_OK) << pliant_last_error();
  pliant_haptic_device played{0}, heard{0};
  ASSERT_EQ(pliant_haptic_device_open(text.c_str(), &played), PLIANT_OK) << pliant_last_error();
  int port = -1;
  ASSERT_EQ(pliant_haptic_device_port(played, &port), PLIANT_OK);
  EXPECT_EQ(port, 0);
  ASSERT_EQ(pliant_haptic_device_open("udp:0", &heard), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(pliant_haptic_device_port(heard, &port), PLIANT_OK);
  EXPECT_GT(port, 0);
  EXPECT_EQ(pliant_manual_device_set_pose(heard, kRest, kRest, 0), PLIANT_USAGE) << "somebody else moves it";
  EXPECT_EQ(pliant_haptic_device_destroy(played), PLIANT_OK);
  EXPECT_EQ(pliant_haptic_device_destroy(heard), PLIANT_OK);
  EXPECT_EQ(pliant_haptic_device_open("telepathy", &heard), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_open("file:no/such/stroke.csv", &heard), PLIANT_IO);
  EXPECT_EQ(heard.id, 0U);
}

TEST_F(CHaptics, ALoopOutlivesItsWorldAndHandles) {
  put(0);
  {
    CCube other;
    ASSERT_EQ(pliant_world_parse_tool(other, R"({"name": "b", "shape": {"sphere": 0.01}, "path": [[0, 0.02, 0.02, 0.06]]})",
                                      nullptr, nullptr, 0),
              PLIANT_OK);
    ASSERT_EQ(pliant_haptic_loop_create(other, "b", device, nullptr, &loop), PLIANT_OK) << pliant_last_error();
  }
  ASSERT_EQ(pliant_haptic_device_destroy(device), PLIANT_OK);
  const std::int64_t ticks = state().ticks;
  EXPECT_TRUE(wait_for([&] { return state().ticks > ticks + 3; }));
  std::vector<std::thread> stopping;  // any thread, several at once
  for (int i = 0; i < 4; ++i) stopping.emplace_back([this] { EXPECT_EQ(pliant_haptic_loop_stop(loop), PLIANT_OK); });
  for (std::thread& t : stopping) t.join();
  EXPECT_EQ(state().running, 0);
}

TEST_F(CHaptics, StructsOfOtherVersions) {
  put(0);
  start(device);
  expect_checked<pliant_device_counts>(PLIANT_DEVICE_COUNTS_INIT,
                                       [&](pliant_device_counts* out) { return pliant_haptic_device_counts(device, out); });
  expect_checked<pliant_device_limits>(PLIANT_DEVICE_LIMITS_INIT,
                                       [&](pliant_device_limits* out) { return pliant_haptic_device_limits(device, out); });
  expect_checked<pliant_device_wrench>(PLIANT_DEVICE_WRENCH_INIT,
                                       [&](pliant_device_wrench* out) { return pliant_manual_device_wrench(device, out); });
  expect_checked<pliant_haptic_state>(PLIANT_HAPTIC_STATE_INIT,
                                      [&](pliant_haptic_state* out) { return pliant_haptic_loop_state(loop, out, nullptr); });
  expect_checked<pliant_haptic_sample>(PLIANT_HAPTIC_SAMPLE_INIT,
                                       [&](pliant_haptic_sample* out) { return pliant_haptic_loop_state(loop, nullptr, out); });
  std::size_t given = 0;
  EXPECT_TRUE(wait_for([&] { return state().ticks > 3; }));
  pliant_haptic_loop_stop(loop);
  expect_checked<pliant_haptic_sample>(
      PLIANT_HAPTIC_SAMPLE_INIT, [&](pliant_haptic_sample* out) { return pliant_haptic_loop_samples(loop, out, 1, &given); });
  options.size = offsetof(pliant_haptic_options, realtime) + 3;
  pliant_haptic_loop second{17};
  EXPECT_EQ(pliant_haptic_loop_create(world, "ball", device, &options, &second), PLIANT_USAGE);
  EXPECT_EQ(second.id, 0U);
  pliant_device_limits limits = PLIANT_DEVICE_LIMITS_INIT;
  limits.size = 3;
  pliant_haptic_device none{17};
  EXPECT_EQ(pliant_manual_device_create(&limits, &none), PLIANT_USAGE);
  EXPECT_EQ(none.id, 0U);
}

TEST_F(CHaptics, MisuseIsRefused) {
  Hand hand;
  pliant_haptic_device none{17};
  EXPECT_EQ(pliant_haptic_device_open(nullptr, &none), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_open("udp:0", nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_create(nullptr, nullptr, &none), PLIANT_USAGE);
  hand.callbacks.read = nullptr;
  EXPECT_EQ(pliant_haptic_device_create(&hand.callbacks, nullptr, &none), PLIANT_USAGE);
  EXPECT_NE(std::string(pliant_last_error()).find("\"read\""), std::string::npos);
  EXPECT_EQ(hand.released, 0);
  EXPECT_EQ(none.id, 0U);
  EXPECT_EQ(pliant_manual_device_set_pose(device, nullptr, kRest, 0), PLIANT_USAGE);
  EXPECT_EQ(pliant_manual_device_set_pose(device, kRest, nullptr, 0), PLIANT_USAGE);
  EXPECT_EQ(pliant_manual_device_wrench(device, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_counts(device, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_limits(device, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_device_port(device, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_create(world, nullptr, device, nullptr, &loop), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_create(world, "ball", device, nullptr, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_create(world, "rod", device, nullptr, &loop), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_create(world, "ball", {0}, nullptr, &loop), PLIANT_USAGE);
  EXPECT_STREQ(pliant_last_error(), "the handle names no device (its id is 0)");
  EXPECT_EQ(pliant_haptic_loop_create(world, "ball", {9999}, nullptr, &loop), PLIANT_STATE);
  EXPECT_EQ(pliant_haptic_loop_create({0}, "ball", device, nullptr, &loop), PLIANT_USAGE);
  start(device);
  pliant_haptic_loop second{17};
  EXPECT_EQ(pliant_haptic_loop_create(world, "ball", device, nullptr, &second), PLIANT_USAGE);
  EXPECT_EQ(second.id, 0U);
  EXPECT_EQ(pliant_haptic_loop_samples(loop, nullptr, 1, nullptr), PLIANT_USAGE);
  std::size_t given = 0;
  EXPECT_EQ(pliant_haptic_loop_samples(loop, nullptr, 1, &given), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_samples(loop, nullptr, 0, &given), PLIANT_OK);
  EXPECT_EQ(pliant_haptic_loop_write_log(loop, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_haptic_loop_write_log(loop, "stroke.csv"), PLIANT_STATE);
  const pliant_haptic_loop dead = loop;
  ASSERT_EQ(pliant_haptic_loop_destroy(loop), PLIANT_OK);
  EXPECT_EQ(pliant_haptic_loop_destroy(dead), PLIANT_STATE);
  EXPECT_EQ(pliant_haptic_loop_stop(dead), PLIANT_STATE);
  EXPECT_EQ(pliant_haptic_loop_state(dead, nullptr, nullptr), PLIANT_STATE);
  EXPECT_EQ(pliant_haptic_loop_samples(dead, nullptr, 0, &given), PLIANT_STATE);
  EXPECT_EQ(pliant_haptic_loop_stop({0}), PLIANT_USAGE);
}

}  // namespace
}  // namespace pliant::c_haptics_test
