// The simulated device and hand against closed forms and Eigen's exponentials.
#include "haptics/hand.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "support/error_of.h"

namespace pliant::haptics::hand_test {
namespace {

TEST(SimulatedHand, AFreeMassFallsByHalfATSquared) {
  HandOptions options;
  options.translation = {0.25, 0, 0, 0};
  SimulatedHand hand(options);
  hand.write({{1, -2, 0.5}, {}, 0, 0});
  for (int k = 0; k < 100; ++k) hand.advance(0.01);
  EXPECT_NEAR(hand.pose().position[0], 2, 1e-12);
  EXPECT_NEAR(hand.pose().position[1], -4, 1e-12);
  EXPECT_NEAR(hand.velocity()[2], 2, 1e-12);
  EXPECT_NEAR(hand.work(), 0.5 * 0.25 * (16 + 64 + 4), 1e-11) << "the work is the kinetic energy";
  EXPECT_NEAR(hand.time(), 1, 1e-12);
}

/// Step responses: swinging, at the limit, and creeping.
TEST(SimulatedHand, StepResponses) {
  const double m = 0.3, k = 250, force = 1.7;
  const double w = std::sqrt(k / m);
  for (const double ratio : {0.1, 1.0, 3.0}) {
    for (const double dt : {1e-4, 3.3e-3, 0.4}) {
      HandOptions options;
      options.translation = {m, 0.25 * ratio * 2 * m * w, k, 0.75 * ratio * 2 * m * w};
      SimulatedHand hand(options);
      hand.write({{0, force, 0}, {}, 0, 0});
      for (int n = 1; n <= 20; ++n) {
        hand.advance(dt);
        const double t = n * dt;
        double left = 0;  // of the way to the resting place
        if (ratio < 1) {
          const double wd = w * std::sqrt(1 - ratio * ratio);
          left = std::exp(-ratio * w * t) * (std::cos(wd * t) + ratio * w / wd * std::sin(wd * t));
        } else if (ratio == 1) {
          left = std::exp(-w * t) * (1 + w * t);
        } else {
          const double root = w * std::sqrt(ratio * ratio - 1), slow = root - ratio * w, fast = -root - ratio * w;
          left = (slow * std::exp(fast * t) - fast * std::exp(slow * t)) / (slow - fast);
        }
        ASSERT_NEAR(hand.pose().position[1], force / k * (1 - left), 1e-12) << ratio << " " << dt << " " << n;
      }
    }
  }
}

TEST(SimulatedHand, FollowsAPathAsTheExponentialSays) {
  HandOptions options;
  options.translation = {0.2, 0.7, 300, 5};
  options.path = {{0, 0.1, 0, 0, 0, 0, 0, 1}, {2, 0.5, 0, 0, 0, 0, 0, 1}};
  SimulatedHand hand(options);
  EXPECT_EQ(hand.pose().position[0], 0.1);
  // (x, v, path, path', force)
  Eigen::Matrix<double, 5, 5> a = Eigen::Matrix<double, 5, 5>::Zero();
  a(0, 1) = a(2, 3) = 1;
  a.row(1) << -300 / 0.2, -5.7 / 0.2, 300 / 0.2, 5 / 0.2, 1 / 0.2;
  Eigen::Matrix<double, 5, 1> z;
  z << 0.1, 0, 0.1, 0.2, 0;
  for (int n = 0; n < 40; ++n) {
    const double dt = n % 2 == 0 ? 0.013 : 0.002;
    z(4) = std::sin(n);
    hand.write({{std::sin(n), 0, 0}, {}, 0, 0});
    hand.advance(dt);
    z = ((a * dt).exp() * z).eval();
    ASSERT_NEAR(hand.pose().position[0], z(0), 1e-12) << n;
    ASSERT_NEAR(hand.velocity()[0], z(1), 1e-10) << n;
  }
}

TEST(SimulatedHand, TurnsAboutAnAxisAsItMoves) {
  HandOptions options;
  options.rotation = {2e-4, 1e-3, 0.4, 4e-3};
  options.translation = options.rotation;
  const double angle = 0.6;
  options.path = {{0, 0, 0, 0, 0, 0, 0, 1}, {1, 0, 0, angle, 0, 0, std::sin(angle / 2), std::cos(angle / 2)}};
  SimulatedHand hand(options);
  for (int n = 0; n < 500; ++n) {
    hand.write({{0, 0, 0.05 * std::sin(n)}, {0, 0, 0.05 * std::sin(n)}, 0, 0});
    hand.advance(1e-3);
    ASSERT_NEAR(turn_between({}, hand.pose())[2], hand.pose().position[2], 1e-10) << n;
    ASSERT_NEAR(hand.spin()[2], hand.velocity()[2], 1e-8) << n;
  }
  EXPECT_GT(hand.pose().position[2], 0.2);
}

TEST(SimulatedHand, ExertsNoMoreThanItsLimits) {
  HandOptions options;
  options.translation = {1, 0, 0, 0};
  options.rotation = {1, 0, 0, 0};
  options.limits = {.force = 5, .torque = 0.1};
  SimulatedHand hand(options);
  hand.write({{30, 40, 0}, {0, 0, 7}, 0, 0});
  hand.advance(1);
  EXPECT_NEAR(hand.velocity()[0], 3, 1e-12);
  EXPECT_NEAR(hand.velocity()[1], 4, 1e-12);
  EXPECT_NEAR(hand.spin()[2], 0.1, 1e-12);
  EXPECT_EQ(hand.limits().force, 5);
}

TEST(SimulatedHand, SamplesAreNumbered) {
  SimulatedHand hand({});
  EXPECT_EQ(hand.read().number, 1u);
  hand.advance(0.25);
  hand.advance(0);
  hand.advance(std::nan(""));
  const DeviceSample sample = hand.read();
  EXPECT_EQ(sample.number, 2u);
  EXPECT_EQ(sample.time, 0.25);
  HandOptions options;
  options.wall_time = true;
  SimulatedHand clock(options);
  const double first = clock.read().time;
  double last = first;
  for (int k = 0; k < 1000; ++k) {
    const double now = clock.read().time;
    ASSERT_GE(now, last);
    last = now;
  }
  EXPECT_EQ(first, 0);
  EXPECT_GT(last, 0);
}

TEST(SimulatedHand, RefusesWhatCannotMove) {
  HandOptions options;
  options.translation.mass = 0;
  EXPECT_NE(test::error_of([&] { SimulatedHand{options}; }).find("the mass of the translation is 0"), std::string::npos);
  options.translation = {1, 0, -3, 0};
  EXPECT_NE(test::error_of([&] { SimulatedHand{options}; }).find("-3"), std::string::npos);
}

}  // namespace
}  // namespace pliant::haptics::hand_test
