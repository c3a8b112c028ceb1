// Hands that hold a blade or a tool that grips: what a device may drive, and that the buffer feels what the whole model feels.
#include <gtest/gtest.h>

#include <cmath>

#include "allocations.h"
#include "followed.h"
#include "geometry/vec.h"
#include "haptics/grip_button.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

using haptics_test::block_scene;
using haptics_test::Felt;
using haptics_test::follow;
using haptics_test::kBall;
using haptics_test::kTop;
using haptics_test::simulate;
using haptics_test::Stroke;

constexpr double kToughness = 8000, kEdge = 0.0005, kLength = 0.12, kMiddle = 0.052;

/// The block with a blade across it, `gap` above its top, that cuts by force.
Scene blade_scene(double gap = 0.0005) {
  Scene scene = block_scene();
  scene.tools.clear();
  scene.bodies[0].material.toughness = kToughness;
  Blade blade;
  blade.name = "scalpel";
  blade.cuts = BladeCuts::by_force;
  blade.edge = kEdge;
  blade.friction = 0.1;
  const double y = kTop + gap;
  blade.path = {{0, kMiddle, y, -0.01, kMiddle, y, kLength - 0.01}};
  scene.blades = {blade};
  return scene;
}

/// Of all samples over the tissue, 0.1 m: K_I kappa zeta 2 r l (docs/cutting.md).
constexpr double kGivesWay = kToughness * 2 * kEdge * 0.1;

/// Down by `depth` within `seconds`, then still.
Stroke lowered(double depth, double seconds, double gap = 0.0005) {
  return [=](double t) {
    const double s = std::clamp(t / seconds, 0.0, 1.0), share = s * s * (3 - 2 * s);
    return blade_pose(BladeSegment{Vec3d{kMiddle, kTop + gap - (depth + gap) * share, -0.01},
                                   Vec3d{kMiddle, kTop + gap - (depth + gap) * share, kLength - 0.01}});
  };
}

TEST(DrivenPart, ABladesPoseIsItsEdge) {
  for (const Vec3d& d : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}, Vec3d{-0.6, 0.48, 0.64}}) {
    const Vec3d a{0.1, -0.2, 0.3}, b = vec::add(a, vec::mul(d, 0.07));
    const BladeSegment edge = blade_edge(blade_pose({a, b}), 0.07);
    EXPECT_LT(vec::norm(vec::sub(edge[0], a)), 1e-15) << d[0];
    EXPECT_LT(vec::norm(vec::sub(edge[1], b)), 1e-15) << d[0];
  }
}

TEST(DrivenPart, IsWhatIsThere) {
  const auto s = simulate(blade_scene());
  EXPECT_EQ(DrivenPart::names(*s), std::vector<std::string>{"scalpel"});
  EXPECT_TRUE(DrivenPart::find(*s, "scalpel"));
  EXPECT_FALSE(DrivenPart::find(*s, "ball"));
  s->lift_blade_by_force("scalpel");
  EXPECT_FALSE(DrivenPart::find(*s, "scalpel"));
}

/// A hand that is too quick is followed at the greatest speed, along its way.
TEST(DrivenPart, ABladeGoesAsFarAsItMay) {
  const auto s = simulate(blade_scene());
  const DrivenPart part = DrivenPart::find(*s, "scalpel").value();
  const Pose from = part.pose(*s, 0);
  constexpr double kSeconds = 0.01;
  Pose near = from, far = from;
  near.position[1] += 0.5 * s->blade_drive_speed() * kSeconds;
  far.position[1] += 20 * s->blade_drive_speed() * kSeconds;
  EXPECT_EQ(part.within_reach(*s, near, kSeconds), near);
  EXPECT_THROW(part.drive(*s, far, kSeconds), Error);
  const Pose reached = part.within_reach(*s, far, kSeconds);
  EXPECT_NEAR(reached.position[1] - from.position[1], s->blade_drive_speed() * kSeconds,
              0.02 * s->blade_drive_speed() * kSeconds);
  EXPECT_NEAR(reached.position[0], from.position[0], 1e-12);
  part.drive(*s, reached, kSeconds);
  const Pose turned{from.position, {0, 0.05, 0, std::sqrt(1 - 0.05 * 0.05)}};
  part.drive(*s, part.within_reach(*s, turned, kSeconds), kSeconds);
}

/// The force of the last step before a drive acts half a step beyond it, and that of the first one began half a step before.
TEST(DrivenPart, WorkDoesNotDependOnTheNumberOfDrives) {
  double work[2] = {};
  for (const int drives : {1, 60}) {
    const auto s = simulate(blade_scene());
    const DrivenPart part = DrivenPart::find(*s, "scalpel").value();
    const double way = 0.012 / drives;
    const std::int64_t steps = 600 / drives;
    Pose to = part.pose(*s, 0);
    for (int k = 0; k < drives; ++k) {
      to.position[1] -= way;
      part.drive(*s, to, static_cast<double>(steps) * s->dt());
      s->advance(steps);
    }
    EXPECT_GT(s->topology_version(), 0);
    work[drives == 1 ? 0 : 1] = s->press().work(0);
  }
  EXPECT_NEAR(work[1], work[0], 1e-6 * work[0]);
}

/// Until tissue gives way nothing differs but the order of sums.
TEST(BladeInHand, OfTheWholeBodyIsTheFullModel) {
  const Felt felt = follow(blade_scene(), "scalpel", lowered(0.002, 0.05), {.rings = -1, .every = 7, .from = 14});
  EXPECT_GT(felt.largest, 0.2 * kGivesWay);
  EXPECT_EQ(felt.cuts, 0);
  EXPECT_TRUE(felt.covered);
  EXPECT_LT(felt.most, 1e-4 * felt.largest);
}

TEST(BladeInHand, FeelsTheFullModelWhileItCuts) {
  const Felt felt = follow(blade_scene(), "scalpel", lowered(0.02, 0.8), {3, 14, 1200});
  EXPECT_GT(felt.cuts, 0);
  EXPECT_GT(felt.built, 1U);
  EXPECT_EQ(felt.resets, 0U);
  EXPECT_TRUE(felt.covered);
  EXPECT_GT(felt.largest, 0.9 * kGivesWay);
  EXPECT_LT(felt.most, 0.12 * felt.largest);
  EXPECT_NEAR(vec::norm(felt.last), vec::norm(felt.last_full), 0.01 * felt.largest);
}

/// The simulation has cut further than the hand has come, which feels its own edge cut all the while.
TEST(BladeInHand, DoesNotFeelThatTheSimulationIsAhead) {
  const Felt felt = follow(blade_scene(), "scalpel", lowered(0.02, 0.8), {.every = 14, .steps = 340, .from = 180, .ahead = 20});
  EXPECT_GT(felt.cuts, 0);
  EXPECT_LT(felt.most, 0.2 * felt.largest);
}

/// Tissue gives way under the hand although the simulation has stalled: the force stays at what cutting takes.
TEST(BladeInHand, TissueGivesWayAtTheHapticRate) {
  const Felt felt = follow(blade_scene(), "scalpel", lowered(0.02, 0.3), {3, 20, 1200, 100});
  EXPECT_GT(felt.felt, 0.9 * kGivesWay);
  EXPECT_LT(felt.felt, 1.15 * kGivesWay);
}

TEST(BladeInHand, TicksAllocateNothing) {
  const auto s = simulate(blade_scene());
  const Stroke stroke = lowered(0.02, 0.3);
  BufferSource source("scalpel", 3);
  BufferForce force(1);
  std::array<BufferMessage, 3> messages;
  std::int64_t pressing = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const double t = 0.01 * frame;
    BufferMessage& message = messages[static_cast<std::size_t>(frame) % 3];
    source.fill(*s, force.in_use(), message);
    const long before = haptics_test::allocations();
    force.receive(message, 0.01);
    for (int k = 0; k < 10; ++k) force.tick(stroke(t + 0.001 * k), 1e-3);
    EXPECT_EQ(haptics_test::allocations(), before);
    if (force.buffer() != nullptr) pressing = std::max(pressing, force.buffer()->contacts());
    const DrivenPart part = DrivenPart::find(*s, "scalpel").value();
    part.drive(*s, part.within_reach(*s, stroke(t + 0.01), 0.01), 0.01);
    while (s->time() < t + 0.01 - 0.5 * s->dt()) s->advance(1);
  }
  EXPECT_GT(s->topology_version(), 0);
  EXPECT_GT(pressing, 5);
}

/// Forceps: the ball sinks in, grips and pulls up.
Scene grip_scene() {
  Scene scene = block_scene();
  scene.tools[0].grip = GripSpec{0, {{0.1, 100}}};
  return scene;
}

Pose pulled(double t) {
  const auto eased = [](double s) {
    return std::clamp(s, 0.0, 1.0) * std::clamp(s, 0.0, 1.0) * (3 - 2 * std::clamp(s, 0.0, 1.0));
  };
  const double down = 0.004 * eased(t / 0.08), up = 0.012 * eased((t - 0.12) / 0.15);
  return {{0.05, kTop + kBall + 0.001 - down + up, 0.05}, {0, 0, 0, 1}};
}

TEST(GripInHand, OfTheWholeBodyIsTheFullModel) {
  const Felt felt = follow(grip_scene(), "ball", pulled, {-1, 7, 900});
  EXPECT_LT(felt.last_full[1], -0.05);         // the tissue pulls the ball down
  EXPECT_LT(felt.most, 0.005 * felt.largest);  // the grip begins with the next message
}

TEST(GripInHand, PullsTheHand) {
  const Felt felt = follow(grip_scene(), "ball", pulled, {3, 20, 900});
  EXPECT_LT(felt.last_full[1], -0.05);
  EXPECT_LT(felt.most, 0.1 * felt.largest);
  EXPECT_EQ(felt.resets, 0U);
}

/// It grips in the tick in which the hand closes it, before the simulation knows.
TEST(GripInHand, FollowsTheButton) {
  Scene scene = grip_scene();
  scene.tools[0].grip = GripSpec{};
  const auto s = simulate(scene);
  while (s->time() < 0.1) s->advance(1), s->tools().drive("ball", pulled(s->time() + s->dt()), s->dt());
  BufferSource source("ball", 4);
  BufferForce force(1);
  BufferMessage message;
  source.fill(*s, 0, message);
  force.receive(message, 0.01);
  GripButton button(1);
  Wrench felt;
  const auto pull = [&](std::uint32_t buttons) {
    for (int k = 0; k < 170; ++k) {
      force.grip(button.read(buttons));
      felt = force.tick(pulled(0.1 + 0.001 * k), 1e-3);
    }
    return felt.force[1];
  };
  EXPECT_EQ(pull(1), 0);  // another button
  force.receive(message, 0.01);
  force.tick(pulled(0.1), 1e-3);
  EXPECT_LT(pull(2), -0.05);
  for (int k = 0; k < 3; ++k) force.grip(button.read(0)), felt = force.tick(pulled(0.27), 1e-3);
  EXPECT_EQ(felt.force[1], 0);
}

/// A buffer that is built while the tool holds tissue holds it, too.
TEST(GripInHand, GoesOnInANewBuffer) {
  const auto s = simulate(grip_scene());
  while (s->time() < 0.3) {
    s->tools().drive("ball", pulled(s->time() + 0.01), 0.01);
    const double until = s->time() + 0.01;
    while (s->time() < until - 0.5 * s->dt()) s->advance(1);
  }
  BufferSource source("ball", 4);
  BufferForce force(1);
  BufferMessage message;
  source.fill(*s, 0, message);
  force.receive(message, 0.01);
  Wrench felt;
  for (int k = 0; k < 20; ++k) felt = force.tick(pulled(0.3), 1e-3);
  const Wrench full = DrivenPart::find(*s, "ball")->last(*s).value();
  EXPECT_LT(full.force[1], -0.05);
  EXPECT_NEAR(felt.force[1], full.force[1], 0.1 * std::abs(full.force[1]));
}

}  // namespace
}  // namespace pliant::haptics
