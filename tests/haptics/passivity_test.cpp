// The account of energy against sums over recorded motions, the damper against Hannaford and Ryu's equations, and a million
// ticks of walls with and without it.
#include "haptics/passivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "haptics/hand.h"
#include "haptics/motion.h"
#include "haptics/safety.h"

namespace pliant::haptics::passivity_test {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
}
Vec3d any(std::mt19937& random, double size) {
  Vec3d v{};
  for (double& c : v) c = uniform(random, -size, size);
  return v;
}

TEST(PassivityObserver, AddsUpTheWorkOfHeldForces) {
  PassivityObserver observer({.allowance = 0.25, .damping = 0.5});
  observer.moved({1, 1, 1}, 0);  // no time, no motion
  observer.exert({2, 0, 0});
  observer.moved({0.01, 5, 0}, 0.1);  // takes 0.02 J, the damper 0.5 (25 + 1e-4) / 0.1
  EXPECT_NEAR(observer.energy(), 0.25 - 0.02 + 125.0005, 1e-12);
  observer.exert({0, 0, -3});
  observer.moved({0, 0, 0.002}, 1);
  EXPECT_NEAR(observer.energy(), 0.25 - 0.02 + 125.0005 + 0.006 + 2e-6, 1e-12);
  EXPECT_EQ(observer.least(), 0.25);
}

/// Hannaford and Ryu (2002), series controller, one component, with their energy of each tick: f v T.
TEST(PassivityController, IsThatOfHannafordAndRyu) {
  std::mt19937 random(3);
  const double dt = 1e-3;
  PassivityController controller({.allowance = 0});
  double energy = 0, step = 0;
  int corrected = 0;
  for (int k = 0; k < 20000; ++k) {
    const double v = uniform(random, -0.2, 0.2), f2 = uniform(random, -1, 1) - v;  // f2: on the environment
    const double w = energy + f2 * v * dt, alpha = w < 0 ? -w / (dt * v * v) : 0;
    const double f1 = f2 + alpha * v;
    energy = w + alpha * v * v * dt;
    corrected += alpha > 0;
    const Vec3d out = controller.tick({step, 0, 0}, {v, 0, 0}, {-f2, 0, 0}, dt);
    ASSERT_NEAR(out[0], -f1, 1e-9) << k;
    step = v * dt;
  }
  EXPECT_GT(corrected, 10);
  EXPECT_NEAR(static_cast<double>(controller.corrections()), corrected, 3);
  EXPECT_GE(controller.observer().least(), -1e-12);
}

TEST(PassivityController, KeepsTheAccountWhateverTheHandDoesWithinTheBound) {
  for (const double damping : {0.0, 0.3}) {
    std::mt19937 random(5);
    const double dt = 1e-3, acceleration = 100;
    PassivityController controller({.allowance = 1e-4, .damping = damping, .acceleration = acceleration});
    Vec3d v{}, step{};
    double given = 1e-4;
    for (int k = 0; k < 50000; ++k) {
      const Vec3d force = vec::add(any(random, 2), vec::mul(v, uniform(random, 0, 5)));  // mostly drives the hand
      const Vec3d out = controller.tick(step, v, force, dt);
      Vec3d push = any(random, 1);
      if (k % 2 == 0) push = out;  // the worst that a hand can do: to follow the force
      const double size = vec::norm(push);
      const Vec3d a = size > 0 ? vec::mul(push, acceleration / size) : Vec3d{};
      step = vec::add(vec::mul(v, dt), vec::mul(a, dt * dt / 2));
      v = vec::mul(vec::add(v, vec::mul(a, dt)), 0.97);
      given += damping * vec::dot(step, step) / dt - vec::dot(out, step);
      ASSERT_GE(given, -1e-9) << k;
    }
    EXPECT_GT(controller.corrections(), 1000u);
  }
}

TEST(PassivityController, ChangesNothingThatDissipates) {
  std::mt19937 random(6);
  PassivityController controller({.allowance = 0});
  Vec3d step{};
  for (int k = 0; k < 1000; ++k) {
    const Vec3d v = any(random, 0.3), force = vec::mul(v, -uniform(random, 0, 4));
    ASSERT_EQ(controller.tick(step, v, force, 1e-3), force);
    step = vec::mul(v, 1e-3);
  }
  EXPECT_EQ(controller.corrections(), 0u);
}

TEST(PassivityController, PaysADebtBackWithinItsLimit) {
  const double dt = 1e-3;
  PassivityController controller({.allowance = 1e-6, .limit = 0.5});
  EXPECT_EQ(controller.tick({}, {}, {2, 0, 0}, dt), (Vec3d{2, 0, 0})) << "at rest nothing is taken";
  Vec3d step{1e-3, 0, 0};  // the hand has gone 1 mm unseen
  double energy = 1e-6 - 2e-3;
  int ticks = 0;
  for (; energy < 0; ++ticks) {
    ASSERT_LT(ticks, 100);
    const Vec3d out = controller.tick(step, {0.1, 0, 0}, {2, 0, 0}, dt);
    ASSERT_NEAR(controller.observer().energy(), energy, 1e-12);
    ASSERT_LE(out[0], 0);
    ASSERT_GE(out[0], -0.5);
    step = {0.1 * dt, 0, 0};
    energy -= out[0] * step[0];
  }
  EXPECT_EQ(ticks, 40) << "1999 uJ by 50 uJ a tick";
}

/// A spring on the device's own damper. With K = 2 b / T and exact velocities, nothing is ever taken.
TEST(PassivityController, BeginsAtTheLimitOfColgate) {
  for (const double rate : {300.0, 1000.0, 10000.0}) {
    for (const double share : {0.999, 1.5}) {
      const double dt = 1 / rate, damping = 0.5, stiffness = share * 2 * damping / dt;
      PassivityController controller({.allowance = 0, .damping = damping});
      double x = 0, step = 0;
      std::mt19937 random(1);
      for (int k = 0; k < 10000; ++k) {
        const double v = uniform(random, -1, 1) * 0.3 - x / (20 * dt);
        controller.tick({step, 0, 0}, {v, 0, 0}, {-stiffness * x, 0, 0}, dt);
        step = v * dt;
        x += step;
      }
      if (share < 1) {
        EXPECT_EQ(controller.corrections(), 0u) << rate;
      } else {
        EXPECT_GT(controller.corrections(), 10u) << rate;
      }
    }
  }
}

TEST(PassivityGate, KeepsTwoAccounts) {
  PassivityGate gate({.allowance = 1, .limit = 0}, {.allowance = 0, .limit = 0});
  const double dt = 1e-3;
  Pose pose{{0.1, 0, 0}, {}};
  pose.turn = {0, 0, 0, 1};
  gate.tick(pose, {}, {}, {}, dt);
  for (int k = 0; k < 10; ++k) {
    const Wrench out = gate.tick(pose, {0.1, 0, 0}, {0, 0, 2}, {{1, 0, 0}, {0, 0, 0.1}}, dt);
    EXPECT_EQ(out.force, (Vec3d{1, 0, 0})) << "the translation has something left";
    EXPECT_NEAR(vec::norm(out.torque), 0, 1e-15) << "the rotation has not";
    pose.position[0] += 0.1 * dt;
    pose = turned(pose, {0, 0, 2 * dt});
  }
  EXPECT_NEAR(gate.translation().observer().energy(), 1 - 9 * 1e-4, 1e-12);
  EXPECT_NEAR(gate.rotation().observer().energy(), 0, 1e-15);
  gate.exerted({{0, 0, 0}, {0, 0, -0.5}});
  gate.tick(pose, {}, {}, {}, dt);
  EXPECT_NEAR(gate.rotation().observer().energy(), 0.5 * 2 * dt, 1e-12);
}

struct Wall {
  double rate, stiffness, damping;
  int delay;  ///< [ticks]
};

/// Least energy of the port, allowance and all, from the motion alone; the hand presses on a wall two times a second.
double least_energy(const Wall& wall, bool controlled, int ticks, double& felt) {
  HandOptions options;
  for (int row = 0; row < 8000; ++row) {
    const double t = row * 5e-3;
    options.path.push_back({t, 0.004 + 0.01 * std::cos(4 * M_PI * t), 0, 0, 0, 0, 0, 1});
  }
  SimulatedHand hand(options);
  const double dt = 1 / wall.rate, allowance = 1e-3;
  PassivityController controller({.allowance = allowance, .acceleration = 150});
  std::vector<Vec3d> late(static_cast<std::size_t>(wall.delay + 1));
  double energy = allowance, least = allowance;
  Vec3d before = hand.pose().position;
  for (int k = 0; k < ticks; ++k) {
    const Vec3d now = hand.read().position, v = hand.velocity();
    Vec3d wanted{};
    if (now[0] < 0) wanted[0] = std::clamp(-wall.stiffness * now[0] - wall.damping * v[0], -10.0, 10.0);
    Vec3d& slot = late[static_cast<std::size_t>(k) % late.size()];
    slot = wanted;
    const Vec3d force = late[static_cast<std::size_t>(k + 1) % late.size()];
    const Vec3d out = controlled ? controller.tick(vec::sub(now, before), v, force, dt) : force;
    before = now;
    hand.write({out, {}, 0, 0});
    hand.advance(dt);
    energy -= vec::dot(out, vec::sub(hand.pose().position, before));
    least = std::min(least, energy);
    felt = std::max(felt, out[0]);
  }
  controller.tick(vec::sub(hand.pose().position, before), {}, {}, dt);
  if (controlled) {
    EXPECT_NEAR(controller.observer().least(), least, 1e-12 * std::max(1.0, felt)) << "the observer sees the same";
  }
  return least;
}

/// Velocities from differences of samples, with twice the acceleration, and the guard behind, which takes a share.
TEST(Passivity, HoldsForVelocitiesFromDifferences) {
  HandOptions options;
  for (int row = 0; row < 14000; ++row) options.path.push_back({row * 5e-3, 0.01 * std::cos(row * 0.06), 0, 0, 0, 0, 0, 1});
  for (const double rate : {300.0, 1000.0, 5000.0}) {
    SimulatedHand hand(options);
    MotionEstimate estimate(0);
    const double dt = 1 / rate;
    PassivityGate gate({.acceleration = 300}, {});
    ForceGuard guard({.stale_after = 0.5, .ramp = 0.1, .rise = 0.1}, {.force = 4});
    double energy = 1e-3;
    for (int k = 0; k < 20000; ++k) {
      const DeviceSample sample = hand.read();
      const Pose pose{sample.position, sample.turn};
      const Motion motion = estimate.update(sample, dt);
      const double depth = std::max(-sample.position[0], 0.0);
      const Wrench wall{{std::min(4000 * depth, 10.0), 0, 0}, {}};
      const Wrench out = guard.tick(gate.tick(pose, motion.velocity, motion.spin, wall, dt), k % 3000 * dt, dt);
      gate.exerted(out);
      hand.write({out.force, out.torque, 0, 0});
      hand.advance(dt);
      energy -= vec::dot(out.force, vec::sub(hand.pose().position, pose.position));
      ASSERT_GE(energy, -1e-9) << rate << " " << k;
    }
    EXPECT_GT(gate.translation().corrections(), 0u) << rate;
    EXPECT_NEAR(gate.translation().observer().energy(), energy, 0.01) << "but for the last tick";
  }
}

TEST(Passivity, AMillionTicksOfWalls) {
  int active = 0;
  double least = 1, felt = 0, worst_without = 0;
  for (const double rate : {300.0, 1000.0, 3000.0, 10000.0}) {
    for (const double stiffness : {50.0, 500.0, 2000.0, 8000.0}) {
      for (const double damping : {0.0, 2.0}) {
        for (const int delay : {0, 1, 4}) {
          const Wall wall{rate, stiffness, damping, delay};
          double weakest = 0;
          const double energy = least_energy(wall, true, 10500, weakest);
          ASSERT_GE(energy, -1e-9) << rate << " " << stiffness << " " << damping << " " << delay;
          EXPECT_GT(weakest, 0.05) << "the wall is still felt: " << rate << " " << stiffness << " " << damping << " " << delay;
          least = std::min(least, energy);
          felt = 0;
          const double without = least_energy(wall, false, 10500, felt);
          if (without > 5e-4) {
            EXPECT_EQ(weakest, felt) << "what is passive by far is not touched";
          }
          active += without < 0;
          worst_without = std::min(worst_without, without);
        }
      }
    }
  }
  RecordProperty("least_energy_nJ", static_cast<int>(least * 1e9));
  EXPECT_GT(active, 20) << "of 96 walls";
  EXPECT_LT(worst_without, -0.1) << "[J]";
  std::printf("least energy with the controller %.3g J; without it below zero in %d of 96, down to %.3g J\n", least, active,
              worst_without);
}

}  // namespace
}  // namespace pliant::haptics::passivity_test
