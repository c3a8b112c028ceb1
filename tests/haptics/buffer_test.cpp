// The buffer model: what it is made of, and that it feels what the whole model feels.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "allocations.h"
#include "followed.h"

namespace pliant::haptics {
namespace {

using haptics_test::block_scene;
using haptics_test::Felt;
using haptics_test::follow;
using haptics_test::kBall;
using haptics_test::kTop;
using haptics_test::pressed;
using haptics_test::simulate;

/// Steps until `time` with the tool on its way to `pose`; the force in the last step.
Wrench drive_until(Simulation& s, double time, const Pose& pose) {
  s.tools().drive("ball", pose, time - s.time());
  while (s.time() < time - 0.5 * s.dt()) s.advance(1);
  const Wrench& f = s.contact().step_forces().back();
  return {f.force, f.torque};
}

/// The ball is pressed in.
Felt press(const Scene& scene, const haptics_test::Following& how) {
  return follow(
      scene, "ball", [](double t) { return pressed(t); }, how);
}

TEST(Submodel, RingsGrowByACellToEachSide) {
  const auto s = simulate(block_scene());
  const Model& model = s->model();
  const ElementGraph graph(model);
  std::int32_t middle = -1;  // the node in the middle of the top
  for (std::int32_t n = 0; n < model.slots; ++n) {
    const Vec3d& x = model.rest[static_cast<std::size_t>(n)];
    if (model.mass[static_cast<std::size_t>(n)] > 0 && vec::norm(vec::sub(x, {0.05, 0.06, 0.05})) < 1e-6) middle = n;
  }
  ASSERT_GE(middle, 0);
  for (std::int32_t rings = 0; rings < 5; ++rings) {
    const std::vector<std::int32_t> ring = graph.rings({middle}, rings);
    const Submodel part = extract(model, graph, ring);
    const std::int64_t wide = 2 * (rings + 1), deep = rings + 1;
    EXPECT_EQ(part.elements, wide * wide * deep);
    EXPECT_EQ(part.slot.size(), static_cast<std::size_t>((wide + 1) * (wide + 1) * (deep + 1)));
    // The upper side is free but for its edge; the lower one and the four others are the rim.
    const bool all_wide = wide == 10, all_deep = deep == 6;
    const std::int64_t inner = all_wide ? wide + 1 : wide - 1, inner_deep = all_deep ? deep + 1 : deep;
    EXPECT_EQ(std::count(part.rim.begin(), part.rim.end(), 0), inner * inner * inner_deep) << rings;
    double mass = 0;
    for (std::size_t n = 0; n < part.slot.size(); ++n) {
      EXPECT_EQ(part.model->mass[n], model.mass[static_cast<std::size_t>(part.slot[n])]);
      mass += part.model->mass[n];
    }
    EXPECT_GT(mass, 0);
    for (const auto& nodes : part.model->contact->nodes) {
      for (const std::int32_t n : nodes) EXPECT_EQ(part.rim[static_cast<std::size_t>(n)], 0);
    }
    EXPECT_EQ(part.point.size(), part.model->contact->size());
  }
}

/// With all elements of the body it is the whole model: nothing differs but the order of sums.
TEST(Buffer, OfTheWholeBodyIsTheFullModel) {
  for (const ElementKind element : all_elements()) {
    const Felt felt = press(block_scene(element), {-1, 7, 300});
    EXPECT_GT(felt.largest, 0.05) << to_string(element);
    EXPECT_LT(felt.most, 2e-5 * felt.largest) << to_string(element);
    EXPECT_EQ(felt.built, 1U) << to_string(element);
  }
}

TEST(Buffer, OfMoreRingsFeelsMoreLikeTheFullModel) {
  double before = std::numeric_limits<double>::infinity();
  for (const std::int32_t rings : {1, 2, 4}) {
    const Felt felt = press(block_scene(), {rings, 20, 400});
    EXPECT_LT(felt.most, before) << rings;
    EXPECT_TRUE(felt.covered);
    EXPECT_EQ(felt.resets, 0U);
    before = felt.most;
    if (rings == 4) {
      EXPECT_LT(felt.most, 0.05 * felt.largest);
    }
  }
}

/// A buffer that is rebuilt with every frame carries its state over.
TEST(Buffer, IsRebuiltWithoutAJump) {
  const Felt kept = press(block_scene(), {3, 10, 400}),
             rebuilt = press(block_scene(), {.rings = 3, .every = 10, .rebuild = true});
  EXPECT_GT(rebuilt.built, 20U);
  EXPECT_LT(rebuilt.most, kept.most + 0.02 * kept.largest);
}

TEST(Buffer, FollowsTheRim) {
  const auto s = simulate(block_scene());
  BufferSource source("ball", 2);
  BufferMessage message;
  source.fill(*s, 0, message);
  ASSERT_NE(message.model, nullptr);
  BufferModel& buffer = *message.model;
  TissueState state = message.state;
  for (std::size_t i = 0; i < state.displacement.size(); ++i) {
    state.displacement[i] += 1e-4F * static_cast<float>(i % 3);
    state.drift[i] = 0;
  }
  constexpr double kSeconds = 0.02;
  const Pose away{{0.05, 1, 0.05}, {0, 0, 0, 1}};
  buffer.follow(state, kSeconds, 1);
  for (int k = 0; k < 20; ++k) buffer.tick(away, away, kSeconds / 20);
  for (std::size_t n = 0; n < buffer.part().slot.size(); ++n) {
    if (buffer.part().rim[n] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(buffer.displacement(n)[c], state.displacement[3 * n + c], 1e-9);
  }
}

/// Poses come a thousand times a second, whatever the rate of the ticks: a hand that moves on in jumps feels no blows.
TEST(Buffer, FeelsNoBlowsWhereTicksAreMoreThanPoses) {
  const auto largest = [](int ticks) {
    const auto s = simulate(block_scene());
    BufferSource source("ball", 4);
    BufferForce force(1);
    BufferMessage message;
    source.fill(*s, 0, message);
    force.receive(message, 1);
    double most = 0;
    for (int k = 0; k < 150; ++k) {  // 50 mm/s
      for (int i = 0; i < ticks; ++i)
        most = std::max(most, vec::norm(force.tick(pressed(0.001 * k, 0.0075, 0.15), 1e-3 / ticks).force));
    }
    return most;
  };
  EXPECT_LT(largest(10), 1.5 * largest(1));
}

TEST(Buffer, BeginsAnewWhereItBlowsUp) {
  const auto s = simulate(block_scene());
  BufferSource source("ball", 2);
  BufferForce force(1);
  BufferMessage message;
  source.fill(*s, 0, message);
  force.receive(message, 0.01);
  EXPECT_EQ(force.tick(pressed(0), 1e-3).force, (Vec3d{}));
  BufferMessage bad = message;
  bad.state.displacement[4] = std::numeric_limits<float>::quiet_NaN();
  force.receive(bad, 0.01);
  for (int k = 0; k < 16; ++k) EXPECT_TRUE(vec::finite(force.tick(pressed(0), 1e-3).force));
  EXPECT_GT(force.resets(), 0U);
  force.receive(message, 0.01);
  for (int k = 0; k < 100; ++k) force.tick(pressed(0), 1e-3);
  EXPECT_TRUE(force.buffer()->finite());
}

/// Cells with little tissue have inertia added that weighs nothing: a buffer that let it weigh would sag.
TEST(Buffer, WeighsWhatTheBodyWeighs) {
  Scene scene = block_scene();
  scene.gravity = {0, -9.81, 0};
  scene.least_fill = 1;  // in scenes that may be cut
  Blade blade;
  blade.name = "blade";
  blade.path = {{100, 5, 5, 5, 6, 5, 5}, {101, 5, 5, 5, 6, 5, 5}};
  scene.blades = {blade};
  scene.bodies[0].surface_in_memory = std::make_shared<const TriangleMesh>(haptics_test::box({0, 0, 0}, {0.104, kTop, 0.104}));
  ASSERT_FALSE(build_model(scene).added.empty());
  const Felt felt = press(scene, {-1, 7, 200});
  EXPECT_LT(felt.most, 2e-5 * std::max(felt.largest, 0.05));
}

TEST(Buffer, BeginsAnewWithASimulationThatDoes) {
  const auto s = simulate(block_scene());
  BufferSource source("ball", 3);
  BufferForce force(1);
  BufferMessage before, after;
  drive_until(*s, 0.2, pressed(0.2));
  source.fill(*s, 0, before);
  force.receive(before, 0.01);
  for (int k = 0; k < 20; ++k) force.tick(pressed(0.2), 1e-3);
  const auto fresh = simulate(block_scene());
  source.fill(*fresh, force.in_use(), after);
  EXPECT_NE(after.run, before.run);
  force.receive(after, 0.01);
  for (std::size_t n = 0; n < force.buffer()->part().slot.size(); ++n) EXPECT_EQ(force.buffer()->displacement(n), (Vec3d{}));
}

TEST(Buffer, IsNoneWhereNothingIsNear) {
  const auto s = simulate(block_scene(ElementKind::hex8, 0.2));
  BufferSource source("ball", 2);
  BufferForce force(1);
  BufferMessage message;
  source.fill(*s, 0, message);
  EXPECT_EQ(message.model, nullptr);
  EXPECT_TRUE(message.covered);
  force.receive(message, 0.01);
  EXPECT_EQ(force.tick(pressed(0), 1e-3).force, (Vec3d{}));
  EXPECT_EQ(force.buffer(), nullptr);
}

TEST(Buffer, TellsWhereShapeMatchingIsTouched) {
  Scene scene = block_scene();
  scene.bodies[0].model.type = ModelType::flsm;
  const auto s = simulate(scene);
  BufferSource source("ball", 2);
  BufferMessage message;
  source.fill(*s, 0, message);
  EXPECT_EQ(message.model, nullptr);
  EXPECT_FALSE(message.covered);
}

TEST(Buffer, TicksAllocateNothing) {
  const Scene scene = block_scene();
  const auto s = simulate(scene);
  BufferSource source("ball", 3);
  BufferForce force(1);
  std::array<BufferMessage, 3> messages;
  for (int frame = 0; frame < 30; ++frame) {
    const double t = 0.01 * frame;
    BufferMessage& message = messages[static_cast<std::size_t>(frame) % 3];
    source.fill(*s, force.in_use(), message);
    const long before = haptics_test::allocations();
    force.receive(message, 0.01);
    for (int k = 0; k < 10; ++k) force.tick(pressed(t + 0.001 * k), 1e-3);
    EXPECT_EQ(haptics_test::allocations(), before);
    drive_until(*s, s->time() + 0.01, pressed(t + 0.01));
  }
  EXPECT_GT(force.buffer()->contacts(), 0);
}

}  // namespace
}  // namespace pliant::haptics
