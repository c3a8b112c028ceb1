// Ramps, limits and counts of the last stage before a device.
#include "haptics/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/vec.h"

namespace pliant::haptics::safety_test {
namespace {

constexpr double kTick = 1e-3;
const double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

/// The smooth step from 0 to 1, written another way: the integral of 6 s (1 - s).
double smooth(double s) {
  s = std::min(std::max(s, 0.0), 1.0);
  return 3 * s * s - 2 * s * s * s;
}

TEST(ForceGuard, FadesInAndOutAndInAgain) {
  ForceGuard guard({.stale_after = 0.05, .ramp = 0.02, .rise = 0.04});
  double age = 0;
  const auto force = [&](double older) {
    age = older;
    return guard.tick({{0, 0, 2}, {1, 0, 0}}, age, kTick);
  };
  for (int k = 1; k <= 60; ++k) {
    const Wrench w = force(0.01);
    ASSERT_NEAR(w.force[2], 2 * smooth(k * kTick / 0.04), 1e-12) << k;
    ASSERT_NEAR(w.torque[0], smooth(k * kTick / 0.04), 1e-12) << k;
  }
  EXPECT_EQ(force(0.05).force[2], 2);
  for (int k = 1; k <= 30; ++k) ASSERT_NEAR(force(0.05 + k * kTick).force[2], 2 * smooth(1 - k * kTick / 0.02), 1e-12) << k;
  EXPECT_EQ(guard.weight(), 0);
  for (int k = 1; k <= 10; ++k) force(0);
  EXPECT_NEAR(guard.weight(), smooth(0.25), 1e-12);
  for (int k = 1; k <= 2; ++k) force(kNaN);
  EXPECT_NEAR(guard.weight(), smooth(0.15), 1e-12) << "turns around where it is; an age that is no number is old";
  EXPECT_EQ(guard.counts().gaps, 2u);
  EXPECT_EQ(guard.counts().stale, 32u);
  EXPECT_EQ(guard.counts().ticks, 103u);
  guard.restart();
  EXPECT_EQ(guard.weight(), 0);
}

TEST(ForceGuard, NoStepIsLongerThanTheRampAllows) {
  ForceGuard guard({.stale_after = 0.03, .ramp = 0.02, .rise = 0.05});
  double before = 0;
  std::uint64_t seed = 1;
  double age = 0;
  for (int k = 0; k < 20000; ++k) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    age = (seed >> 33) % 40 == 0 ? 0 : age + kTick;
    const double force = guard.tick({{1, 0, 0}, {}}, age, kTick).force[0];
    ASSERT_LE(std::abs(force - before), 1.5 * kTick / 0.02 + 1e-12);
    ASSERT_GE(force, 0);
    ASSERT_LE(force, 1);
    before = force;
  }
  EXPECT_GT(guard.counts().gaps, 50u);
}

TEST(ForceGuard, KeepsDirectionsWithinTheLimits) {
  ForceGuard guard({.rise = 0}, {.force = 3, .torque = 0.1});
  Wrench w = guard.tick({{3, -4, 12}, {0.06, 0, 0.08}}, 0, kTick);
  EXPECT_NEAR(w.force[0], 9.0 / 13, 1e-14);
  EXPECT_NEAR(w.force[1], -12.0 / 13, 1e-14);
  EXPECT_NEAR(w.force[2], 36.0 / 13, 1e-14);
  EXPECT_EQ(w.torque, (Vec3d{0.06, 0, 0.08}));
  EXPECT_EQ(guard.counts().limited, 1u);
  w = guard.tick({{1e300, 1e300, 0}, {}}, 0, kTick);
  EXPECT_NEAR(w.force[0], 3 / std::sqrt(2.0), 1e-12);
  w = guard.tick({{1, 0, 0}, {0, 0.5, 0}}, 0, kTick);
  EXPECT_EQ(w.force, (Vec3d{1, 0, 0}));
  EXPECT_NEAR(w.torque[1], 0.1, 1e-15);
  EXPECT_EQ(guard.counts().limited, 3u);
  ForceGuard pen({.rise = 0}, {.force = 3, .torque = 0});
  w = pen.tick({{1, 0, 0}, {0, 0.5, 0}}, 0, kTick);
  EXPECT_EQ(w.torque, Vec3d{});
  EXPECT_EQ(pen.counts().limited, 0u) << "a device without torque is not limited in each tick";
}

TEST(ForceGuard, GivesNothingForWhatIsNoNumber) {
  ForceGuard guard({.rise = 0}, {.force = 3, .torque = 1});
  for (const Wrench& bad : {Wrench{{1, kNaN, 0}, {}}, Wrench{{1, 0, 0}, {0, 0, kNaN}}, Wrench{{kInfinity, 0, 0}, {}}}) {
    const Wrench w = guard.tick(bad, 0, kTick);
    EXPECT_EQ(w.force, Vec3d{});
    EXPECT_EQ(w.torque, Vec3d{});
    EXPECT_EQ(guard.tick({{1, 0, 0}, {}}, 0, kTick).force[0], 1) << "only for that tick";
  }
  EXPECT_EQ(guard.counts().not_finite, 3u);
}

}  // namespace
}  // namespace pliant::haptics::safety_test
