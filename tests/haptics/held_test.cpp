// What the reports alone give: ramps, steps, and horizons.
#include "haptics/held.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant::haptics::held_test {
namespace {

constexpr double kFrame = 1.0 / 30, kTick = 1.0 / 3000;

/// Of a frame that ends at `time` with the force `last`, and `mean` over it.
FrameReport report(double time, double mean, double last) {
  FrameReport r;
  r.time = time;
  r.period = kFrame;
  r.mean = {{mean, 0, 0}, {0, 2 * mean, 0}};
  r.last = {{last, 0, 0}, {0, 2 * last, 0}};
  return r;
}

TEST(HeldForce, HoldsTheLastReport) {
  HeldForce mean, last(Sampled::last);
  EXPECT_EQ(mean.tick({}, kTick).force[0], 0);
  mean.receive(report(1, 2, 3));
  last.receive(report(1, 2, 3));
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(mean.tick({}, kTick).force[0], 2);
    EXPECT_EQ(last.tick({}, kTick).torque[1], 6);
  }
}

TEST(ExtrapolatedForce, ARampIsExact) {
  for (const Sampled sampled : {Sampled::mean, Sampled::last}) {
    ExtrapolatedForce model(1, sampled);
    const auto force = [](double t) { return 0.3 + 5 * t; };
    for (int frame = 0; frame < 10; ++frame) {
      const double time = frame * kFrame;
      model.receive(report(time, force(time - kFrame / 2), force(time)));
      for (int k = 1; k <= 150; ++k) {  // beyond the next report, which is late
        const Wrench w = model.tick({}, kTick);
        if (frame == 0) continue;
        ASSERT_NEAR(w.force[0], force(time + k * kTick), 1e-9) << frame << " " << k;
        ASSERT_NEAR(w.torque[1], 2 * force(time + k * kTick), 1e-9) << frame << " " << k;
      }
    }
  }
}

TEST(ExtrapolatedForce, AStepOvershootsByItsHeight) {
  const double horizon = 0.6 * kFrame;
  ExtrapolatedForce model(horizon, Sampled::last);
  model.receive(report(0, 0, 0));
  model.receive(report(kFrame, 0, 4));  // has stepped in between
  for (int k = 1; k <= 100; ++k)
    ASSERT_NEAR(model.tick({}, kTick).force[0], 4 + 4 * std::min(k * kTick, horizon) / kFrame, 1e-9) << k;
  model.receive(report(2 * kFrame, 0, 4));
  EXPECT_EQ(model.tick({}, kTick).force[0], 4);
}

TEST(ExtrapolatedForce, BeginsAgainWhereTimeGoesBack) {
  ExtrapolatedForce model(1, Sampled::last);
  model.receive(report(5, 0, 1));
  EXPECT_EQ(model.tick({}, kTick).force[0], 1) << "one report gives no slope";
  model.receive(report(1, 0, 3));
  EXPECT_EQ(model.tick({}, kTick).force[0], 3);
  model.receive(report(1, 0, 7));
  EXPECT_EQ(model.tick({}, kTick).force[0], 7) << "nor do two of the same time";
}

}  // namespace
}  // namespace pliant::haptics::held_test
