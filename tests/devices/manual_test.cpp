// The device that a program moves.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "pliant/error.h"
#include "pliant/haptic_device.h"

namespace pliant::devices {
namespace {

std::string refusal_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(ManualDevice, IsWhereItWasPutLast) {
  ManualDevice device;
  EXPECT_EQ(device.read().number, 0U);
  EXPECT_EQ(device.wrench().number, 0U);
  device.set_pose({1, 2, 3});
  const DeviceSample first = device.read();
  EXPECT_EQ(first.position, (Vec3d{1, 2, 3}));
  EXPECT_EQ(first.turn, (std::array<double, 4>{0, 0, 0, 1}));
  EXPECT_EQ(first.number, 1U);
  EXPECT_EQ(device.read().number, 1U);
  device.set_pose({4, 5, 6});
  device.set_pose({7, 8, 9}, {0.6, 0, 0, 0.8}, 5);
  const DeviceSample last = device.read();
  EXPECT_EQ(last.position, (Vec3d{7, 8, 9}));
  EXPECT_NEAR(last.turn[0], 0.6, 1e-15);
  EXPECT_EQ(last.buttons, 5U);
  EXPECT_EQ(last.number, 3U);
  EXPECT_GT(last.time, first.time);
  EXPECT_EQ(device.counts().received, 3U);
}

TEST(ManualDevice, TellsTheNewestWrench) {
  ManualDevice device;
  device.write({{1, 0, 0}, {}, 0.5, 1});
  device.write({{2, 0, 0}, {0, 3, 0}, 0.6, 2});
  for (int i = 0; i < 2; ++i) {  // as often as one asks
    const DeviceWrench wrench = device.wrench();
    EXPECT_EQ(wrench.force, (Vec3d{2, 0, 0}));
    EXPECT_EQ(wrench.torque, (Vec3d{0, 3, 0}));
    EXPECT_EQ(wrench.time, 0.6);
    EXPECT_EQ(wrench.number, 2U);
  }
  device.write({});
  EXPECT_EQ(device.wrench().force, (Vec3d{}));
}

TEST(ManualDevice, RefusesPosesThatAreNone) {
  ManualDevice device;
  device.set_pose({1, 0, 0});
  EXPECT_EQ(refusal_of([&] { device.set_pose({0, std::nan(""), 0}); }), "set_pose: got a position that is not finite");
  EXPECT_EQ(refusal_of([&] {
              device.set_pose({0, 0, 0}, {0, 0, 0, 2});
            }),
            "set_pose: got a quaternion that is not of unit length");
  EXPECT_EQ(device.read().position, (Vec3d{1, 0, 0}));
  const DeviceCounts counts = device.counts();
  EXPECT_EQ(counts.received, 1U);
  EXPECT_EQ(counts.refused, 2U);
  EXPECT_EQ(counts.last_refusal, "a quaternion that is not of unit length");
}

TEST(ManualDevice, HasTheLimitsThatItWasGiven) {
  EXPECT_EQ(ManualDevice().limits().force, std::numeric_limits<double>::infinity());
  EXPECT_EQ(ManualDevice({3, 0}).limits().force, 3);
  EXPECT_EQ(ManualDevice({3, 0}).limits().torque, 0);
  EXPECT_EQ(refusal_of([] { ManualDevice({-1, 0}); }), "haptic device: its limits are -1 N and 0 N m, expected 0 or more");
  EXPECT_NE(refusal_of([] { ManualDevice({1, std::nan("")}); }), "");
}

TEST(ManualDevice, ThreadsNeverSeeMixedPosesOrWrenches) {
  ManualDevice device;
  std::atomic<bool> done{false};
  const auto move = [&] {
    for (int i = 1; i <= 20000; ++i) {
      const double x = i % 1000;
      device.set_pose({x, x, x});
      const DeviceWrench felt = device.wrench();
      ASSERT_EQ(felt.force[0], felt.torque[2]);
    }
  };
  std::thread loop([&] {
    while (!done) {
      const DeviceSample sample = device.read();
      ASSERT_EQ(sample.position[0], sample.position[2]);
      const auto n = static_cast<double>(sample.number);
      device.write({{n, n, n}, {n, n, n}, sample.time, sample.number});
    }
  });
  std::thread one(move), two(move);
  one.join();
  two.join();
  done = true;
  loop.join();
  EXPECT_EQ(device.counts().received, 40000U);
}

}  // namespace
}  // namespace pliant::devices
