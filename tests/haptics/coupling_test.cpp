// The virtual coupling against the 2 x 2 systems that it solves, against exponentials, and at the limits that it states.
#include "haptics/coupling.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

#include "geometry/vec.h"
#include "haptics/hand.h"
#include "haptics/motion.h"
#include "haptics/passivity.h"
#include "haptics/safety.h"
#include "support/error_of.h"

namespace pliant::haptics::coupling_test {
namespace {

const CouplingOptions kOptions{
    .stiffness = 400, .damping = 1.5, .turn_stiffness = 0.8, .turn_damping = 3e-3, .mass = 0.01, .inertia = 2e-5};

TEST(VirtualCoupling, SolvesItsEquations) {
  const double dt = 1e-3, m = 0.01, k = 400, b = 1.5;
  VirtualCoupling coupling(kOptions, dt);
  double x = 0, v = 0;
  for (int n = 0; n < 300; ++n) {
    const double device = 0.01 * std::sin(0.05 * n), speed = 0.5 * std::cos(0.05 * n), contact = 2 * std::sin(0.3 * n);
    const Coupled out = coupling.step({{0, device, 0}}, {0, speed, 0}, {}, {{0, contact, 0}, {}}, dt);
    Eigen::Matrix2d a;  // x' - T v' = x;  m v' + T K x' + T B v' = m v + T (F + K xd + B vd)
    a << 1, -dt, dt * k, m + dt * b;
    const Eigen::Vector2d next = a.inverse() * Eigen::Vector2d(x, m * v + dt * (contact + k * device + b * speed));
    ASSERT_NEAR(out.instrument.position[1], next[0], 1e-13) << n;
    ASSERT_NEAR(out.on_hand.force[1], contact - m * (next[1] - v) / dt, 1e-9) << "the momentum of the instrument, " << n;
    x = next[0];
    v = next[1];
  }
}

/// In the limit of short ticks: m x'' = F + K (xd - x) + B (vd - x') with a device that moves uniformly.
TEST(VirtualCoupling, ConvergesToTheExponential) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();  // (x, v, xd, 1)
  a(0, 1) = 1;
  a.row(1) << -400 / 0.01, -1.5 / 0.01, 400 / 0.01, (1.5 * 0.3 + 0.7) / 0.01;
  a(2, 3) = 0.3;
  const double exact = ((a * 0.02).exp() * Eigen::Vector4d(0, 0, 0, 1))(0);
  double before = 0;
  for (const double dt : {1e-4, 1e-5, 1e-6}) {
    VirtualCoupling coupling(kOptions, dt);
    double x = 0;
    const int ticks = static_cast<int>(std::lround(0.02 / dt));
    for (int n = 1; n <= ticks; ++n)
      x = coupling.step({{0.3 * n * dt, 0, 0}}, {0.3, 0, 0}, {}, {{0.7, 0, 0}, {}}, dt).instrument.position[0];
    const double miss = std::abs(x - exact);
    EXPECT_LT(miss, 200 * dt * exact);
    if (before > 0) {
      EXPECT_NEAR(before / miss, 10, 1.5) << "first order";
    }
    before = miss;
  }
}

TEST(VirtualCoupling, TurnsAsItMoves) {
  CouplingOptions options = kOptions;
  options.stiffness = options.turn_stiffness;
  options.damping = options.turn_damping;
  options.mass = options.inertia;
  VirtualCoupling coupling(options, 1e-3);
  const Vec3d axis{2.0 / 3, -1.0 / 3, 2.0 / 3};
  for (int n = 0; n < 400; ++n) {
    const double angle = 0.5 * std::sin(0.02 * n), rate = 10 * std::cos(0.02 * n), torque = 0.1 * std::cos(0.11 * n);
    Pose device = turned({}, vec::mul(axis, angle));
    device.position = vec::mul(axis, angle);
    const Coupled out = coupling.step(device, vec::mul(axis, rate), vec::mul(axis, rate),
                                      {vec::mul(axis, torque), vec::mul(axis, torque)}, 1e-3);
    const Vec3d turn = turn_between({}, out.instrument);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(turn[c], out.instrument.position[c], 1e-9) << n;
      ASSERT_NEAR(out.on_hand.torque[c], out.on_hand.force[c], 1e-9) << n;
    }
  }
}

/// Whether an instrument whose device is held swings up against a contact -k x.
bool swings_up(const CouplingOptions& options, double contact, double dt) {
  VirtualCoupling coupling(options, dt);
  coupling.place({{1e-3, 0, 0}});
  double early = 0, late = 0, x = 1e-3;
  for (int n = 0; n < 4000; ++n) {
    x = coupling.step({}, {}, {}, {{-contact * x, 0, 0}, {}}, dt).instrument.position[0];
    double& most = n < 2000 ? early : late;
    most = std::max(most, std::abs(x));
    if (most > 1) return true;
  }
  return late > early;
}

TEST(VirtualCoupling, MeetsContactsAsStiffAsItSays) {
  for (const double dt : {1.0 / 300, 1e-3, 1e-4}) {
    for (const double mass : {0.0, 0.003, 0.05}) {
      CouplingOptions options = kOptions;
      options.mass = mass;
      const double limit = VirtualCoupling(options, dt).stable_contact(dt);
      if (mass == 0) {
        EXPECT_NEAR(limit, 5 * 400 + 2 * 1.5 / dt, 1e-6);
      }
      EXPECT_FALSE(swings_up(options, 0.99 * limit, dt)) << dt << " " << mass;
      EXPECT_TRUE(swings_up(options, 1.01 * limit, dt)) << dt << " " << mass;
    }
  }
}

TEST(VirtualCoupling, IsStableAtAnyStiffnessOfItsOwn) {
  for (const double stiffness : {100.0, 1e4, 1e8, 1e12}) {
    CouplingOptions options = kOptions;
    options.stiffness = options.turn_stiffness = stiffness;
    options.mass = options.inertia = 1e-3;
    VirtualCoupling coupling(options, 1e-3);
    Pose device = turned({{0.1, 0, 0}}, {0.3, 0, 0});
    double most = 0;
    for (int n = 0; n < 5000; ++n) {
      const Pose now = coupling.step(device, {}, {}, {}, 1e-3).instrument;
      most = std::max({most, now.position[0], turn_between({}, now)[0]});
    }
    EXPECT_LT(most, 0.7) << stiffness;
    EXPECT_NEAR(coupling.instrument().position[0], 0.1, 1e-4) << stiffness;
    EXPECT_NEAR(turn_between(coupling.instrument(), device)[0], 0, 1e-4) << stiffness;
  }
}

/// Device, coupling, and anything from nothing to a contact that the instrument can just meet: at rest in the end.
TEST(VirtualCoupling, ThePassiveOneIsStableWithAnyContact) {
  for (const double rate : {300.0, 1000.0, 10000.0}) {
    const double dt = 1 / rate, damping = 0.5;
    const CouplingOptions options = passive_coupling(damping, 1e-3, dt);
    EXPECT_NEAR(options.stiffness * dt / 2 + options.damping, 0.9 * damping, 1e-12);
    const double limit = VirtualCoupling(options, dt).stable_contact(dt);
    for (const double share : {0.0, 0.01, 0.1, 0.5, 0.9}) {
      for (const double mass : {0.05, 0.3, 2.0}) {
        HandOptions free;
        free.translation = {mass, damping, 0, 0};
        SimulatedHand hand(free);
        VirtualCoupling coupling(options, dt);
        hand.place({{5e-3, 0, 0}});
        coupling.place(hand.pose());
        double early = 0, late = 0, x = 5e-3;
        constexpr int kTicks = 100000;
        for (int n = 0; n < kTicks; ++n) {
          const Coupled out = coupling.step(hand.pose(), hand.velocity(), {}, {{-share * limit * x, 0, 0}, {}}, dt);
          x = out.instrument.position[0];
          hand.write({out.on_hand.force, {}, 0, 0});
          hand.advance(dt);
          double& most = n < kTicks / 2 ? early : late;
          most = std::max(most, std::abs(hand.pose().position[0]));
        }
        ASSERT_LE(late, early) << rate << " " << share << " " << mass;
        ASSERT_LE(early, share == 0 ? 1.0 : 6e-3) << rate << " " << share << " " << mass;
      }
    }
  }
}

TEST(VirtualCoupling, RigidIsNone) {
  VirtualCoupling coupling({.rigid = true}, 1e-3);
  const Pose device = turned({{1, 2, 3}}, {0, 0.1, 0});
  const Wrench contact{{1, 0, 0}, {0, 2, 0}};
  const Coupled out = coupling.step(device, {1, 1, 1}, {}, contact, 1e-3);
  EXPECT_EQ(out.instrument, device);
  EXPECT_EQ(out.on_hand.force, contact.force);
  EXPECT_EQ(out.on_hand.torque, contact.torque);
}

/// One bad number costs a tick or two, at each stage of a chain.
TEST(VirtualCoupling, RecoversFromWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), dt = 1e-3;
  SimulatedHand hand({});
  MotionEstimate estimate;
  VirtualCoupling coupling({}, dt);
  PassivityGate gate({}, {});
  ForceGuard guard({.rise = 0});
  Wrench last;
  for (int k = 0; k < 600; ++k) {
    DeviceSample sample = hand.read();
    const Motion motion = estimate.update(sample, dt);
    Wrench contact{{0.3, 0, 0}, {0, 0.01, 0}};
    if (k == 100) contact.force[0] = nan;
    if (k == 110) contact.torque[2] = nan;
    if (k == 120) {
      ++sample.number;
      sample.position[1] = nan;
      estimate.update(sample, dt);
    }
    const Pose device{sample.position, sample.turn};
    const Coupled out = coupling.step(device, motion.velocity, motion.spin, contact, dt);
    last = guard.tick(gate.tick(device, motion.velocity, motion.spin, out.on_hand, dt), 0, dt);
    ASSERT_TRUE(vec::finite(last.force) && vec::finite(last.torque)) << k;
    gate.exerted(last);
    hand.write({last.force, last.torque, 0, 0});
    if (k == 130) hand.write({{nan, 0, 0}, {}, 0, 0});
    hand.advance(dt);
    ASSERT_TRUE(good_pose(hand.pose())) << k;
  }
  EXPECT_GE(guard.counts().not_finite, 2u);
  EXPECT_LE(guard.counts().not_finite, 6u);
  EXPECT_TRUE(std::isfinite(gate.translation().observer().energy()));
  EXPECT_TRUE(std::isfinite(gate.rotation().observer().energy()));
  EXPECT_NEAR(last.force[0], 0.3, 0.02);
  EXPECT_NEAR(last.torque[1], 0.01, 2e-3);
}

TEST(VirtualCoupling, RefusesWhatIsNoNumber) {
  const auto error = [](CouplingOptions options) { return test::error_of([&] { VirtualCoupling(options, 1e-3); }); };
  EXPECT_EQ(error({}), "");
  EXPECT_EQ(error({.stiffness = -1}), "coupling: stiffness is -1, allowed are 0 and more");
  EXPECT_NE(error({.turn_damping = std::numeric_limits<double>::quiet_NaN()}).find("turn_damping is nan"), std::string::npos);
}

TEST(MotionEstimate, IsThatOfUniformMotion) {
  MotionEstimate plain(0), smooth(5e-3);
  Motion of_plain, of_smooth;
  for (int n = 0; n < 200; ++n) {
    DeviceSample sample;
    const std::uint64_t taken = static_cast<std::uint64_t>(n) / 4;  // each sample is seen four times
    sample.time = 1e-3 * static_cast<double>(taken);
    sample.number = taken + 1;
    sample.position = {0.2 * sample.time, 0, -0.1 * sample.time};
    sample.turn = turn_by({0, 3 * sample.time, 0});
    of_plain = plain.update(sample, 2.5e-4);
    of_smooth = smooth.update(sample, 2.5e-4);
    if (taken == 0) {
      EXPECT_EQ(of_plain.velocity[0], 0);
    } else {
      ASSERT_NEAR(of_plain.velocity[0], 0.2, 1e-9);
      ASSERT_NEAR(of_plain.spin[1], 3, 1e-9);
      ASSERT_NEAR(of_smooth.velocity[2], -0.1 * (1 - std::exp(-sample.time / 5e-3)), 1e-9);
    }
  }
}

}  // namespace
}  // namespace pliant::haptics::coupling_test
