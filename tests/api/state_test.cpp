// Displacements and velocities of nodes that a program sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "c_world.h"
#include "scenes.h"

namespace pliant {
namespace {

using test::code_of;
using test::message_of;
using test::on;

/// Stands under constant loads, with a step that stays.
SceneSpec standing_block() {
  SceneSpec scene = test::block(0);
  scene.dt = 1e-3;
  return scene;
}

TEST(SetState, GoesOnWithTheSameBits) {
  for (const std::string& backend : test::float_backends()) {
    World original(standing_block(), on(backend)), other(standing_block(), on(backend));
    original.step(130);
    other.set_state(0, original.displacements(0), original.velocities(0));
    EXPECT_EQ(other.hash(), original.hash()) << backend;
    original.step(200);
    other.step(200);
    EXPECT_EQ(other.hash(), original.hash()) << backend;
  }
}

TEST(SetState, InDoubleUpToRounding) {
  World original(standing_block(), on("cpu:double")), other(standing_block(), on("cpu:double"));
  original.step(130);
  other.set_state(0, original.displacements(0), original.velocities(0));
  original.step(200);
  other.step(200);
  const auto a = original.displacements(0), b = other.displacements(0);
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n][1], b[n][1], 1e-13);
}

TEST(SetState, OfOtherIntegrators) {
  for (const char* word : {"increment", "textbook", "forward-euler"}) {
    SceneSpec scene = standing_block();
    scene.integrator = word;
    scene.dt = 1e-4;
    World original(scene, on("cpu:double")), other(scene, on("cpu:double"));
    original.step(300);
    other.set_state(0, original.displacements(0), original.velocities(0));
    const auto v = original.velocities(0), w = other.velocities(0);
    for (std::size_t n = 0; n < v.size(); ++n) EXPECT_NEAR(v[n][1], w[n][1], 1e-9) << word;
    original.step(100);
    other.step(100);
    const auto a = original.displacements(0), b = other.displacements(0);
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n][1], b[n][1], 1e-9) << word;
  }
}

TEST(SetState, MovesFreeNodesAndLeavesHeldOnes) {
  World world(standing_block(), on("cpu"));
  const std::vector<Vec3d> rest = world.rest_positions(0);
  std::vector<Vec3d> u(rest.size(), Vec3d{0.001, 0, 0}), v(rest.size(), Vec3d{0, 0, 0.25});
  const FramePtr before = world.frame();
  world.set_state(0, u, v);
  EXPECT_TRUE(world.poll());
  const std::vector<Vec3d> now = world.displacements(0), speed = world.velocities(0);
  int held = 0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const bool stands = rest[n][1] < 0.001;
    held += stands ? 1 : 0;
    EXPECT_NEAR(now[n][0], stands ? 0 : 0.001, 1e-9);
    EXPECT_NEAR(speed[n][2], stands ? 0 : 0.25, 1e-7);
  }
  EXPECT_GT(held, 0);
  EXPECT_LT(held, static_cast<int>(rest.size()));
  EXPECT_NEAR(world.frame()->positions[7][0] - before->positions[7][0], 0.001, 1e-6) << "the surface follows";
  world.set_state(0, {}, std::vector<Vec3d>(rest.size()));
  EXPECT_NEAR(world.displacements(0).back()[0], 0.001, 1e-9) << "an empty list leaves what there is";
  EXPECT_EQ(world.velocities(0).back()[2], 0);
  world.set_state(0, std::vector<Vec3d>(rest.size()));
  EXPECT_EQ(world.displacements(0).back()[0], 0);
}

TEST(SetState, FreeFlightIsExact) {
  SceneSpec scene = standing_block();
  scene.bodies[0].fixed.clear();
  scene.bodies[0].material.damping = 0;
  scene.gravity = {};
  World world(scene, on("cpu:double"));
  const std::size_t nodes = world.rest_positions(0).size();
  world.set_state(0, std::vector<Vec3d>(nodes, Vec3d{5, 0, 0}), std::vector<Vec3d>(nodes, Vec3d{0, 0.5, 0}));
  world.step(1000);
  for (const Vec3d& u : world.displacements(0)) {
    EXPECT_NEAR(u[0], 5, 1e-9);
    EXPECT_NEAR(u[1], 0.5, 1e-9);
  }
}

TEST(SetState, OfShapeMatchingAndHybrids) {
  for (const char* type : {"flsm", "hybrid"}) {
    SceneSpec scene = standing_block();
    scene.dt = 0;
    scene.gravity = {};
    scene.bodies[0].model.type = type;
    World world(scene, on("cpu"));
    const std::vector<Vec3d> rest = world.rest_positions(0);
    std::vector<Vec3d> u(rest.size());
    for (std::size_t n = 0; n < rest.size(); ++n) u[n] = {0.1 * rest[n][1], 0, 0};  // sheared
    world.set_state(0, u);
    EXPECT_NEAR(world.displacements(0).back()[0], u.back()[0], 1e-8);
    world.advance(3);
    double most = 0;
    for (const Vec3d& x : world.displacements(0)) most = std::max(most, std::abs(x[0]));
    EXPECT_LT(most, 4e-4) << type << " springs back and comes to rest";
  }
}

TEST(SetState, NoRollbackGoesBehindIt) {
  SceneSpec scene = standing_block();
  scene.dt = 0;  // automatic: a step that turns out too long is made again from the state that was kept last
  scene.gravity = {};
  scene.bodies[0].fixed.clear();
  World world(scene, on("cpu"));
  world.step(70);
  const std::size_t nodes = world.rest_positions(0).size();
  std::vector<Vec3d> u(nodes, Vec3d{1, 0, 0}), v(nodes);
  for (std::size_t n = 0; n < nodes; ++n) v[n] = {0, n % 2 == 0 ? 30.0 : -30.0, 0};  // neighbours fly apart
  world.set_state(0, u, v);
  EXPECT_FALSE(world.step(200).diverged);
  const std::vector<Event> events = world.events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const Event& e) { return e.kind == "rolled_back"; }));
  double mean = 0;
  for (const Vec3d& x : world.displacements(0)) mean += x[0] / static_cast<double>(nodes);
  EXPECT_NEAR(mean, 1, 0.1) << "not where it was before";
}

TEST(SetState, WhileTheWorldRunsFreely) {
  World world(standing_block(), on("cpu"));
  world.run_live();
  const std::size_t nodes = world.rest_positions(0).size();
  world.set_state(0, std::vector<Vec3d>(nodes, Vec3d{0.002, 0, 0}));
  EXPECT_GT(std::abs(world.displacements(0).back()[0]), 1e-5);
  world.stop_live();
}

TEST(SetState, AfterACut) {
  World world(standing_block(), on("cpu"));
  world.cut({{Vec3d{-1, 0.045, -1}, Vec3d{-1, 0.045, 3}, Vec3d{3, 0.045, -1}}});
  world.step(50);
  const std::vector<Vec3d> u = world.displacements(0), v = world.velocities(0);
  const std::uint64_t hash = world.hash();
  world.set_state(0, u, v);
  EXPECT_EQ(world.hash(), hash) << "copies of nodes that a cut has made are nodes as well";
  EXPECT_EQ(world.pieces(0), 2);
}

TEST(SetState, Misuse) {
  World world(standing_block(), on("cpu"));
  const std::size_t nodes = world.rest_positions(0).size();
  const std::uint64_t hash = world.hash();
  EXPECT_EQ(code_of([&] { world.set_state(1, {}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.set_state(0, std::vector<Vec3d>(nodes + 1)); }), ErrorCode::usage);
  EXPECT_NE(message_of([&] { world.set_state(0, {}, std::vector<Vec3d>(3)); }).find("has 3 velocities for"), std::string::npos);
  std::vector<Vec3d> u(nodes);
  u[4][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of([&] { world.set_state(0, u); }).find("at node 4 of its displacements the numbers 0, nan, 0"),
            std::string::npos);
  EXPECT_EQ(world.hash(), hash) << "nothing has changed";
  World lost(test::unstable(), on("cpu"));
  while (!lost.step(50).diverged) {
  }
  EXPECT_EQ(code_of([&] { lost.set_state(0, lost.displacements(0)); }), ErrorCode::diverged);
}

TEST(SetState, InC) {
  const test::CCube cube;
  std::int64_t nodes = 0;
  ASSERT_EQ(pliant_world_body_nodes(cube, 0, &nodes), PLIANT_OK);
  const auto count = static_cast<std::size_t>(3 * nodes);
  std::vector<double> u(count), v(count), got(count);
  u.back() = 0.003;
  v.back() = 0.5;
  ASSERT_EQ(pliant_world_set_state(cube, 0, u.data(), v.data(), count), PLIANT_OK);
  ASSERT_EQ(pliant_world_displacements(cube, 0, got.data(), count), PLIANT_OK);
  EXPECT_NEAR(got.back(), 0.003, 1e-9);
  ASSERT_EQ(pliant_world_set_state(cube, 0, nullptr, u.data(), count), PLIANT_OK);
  ASSERT_EQ(pliant_world_displacements(cube, 0, got.data(), count), PLIANT_OK);
  EXPECT_NEAR(got.back(), 0.003, 1e-9) << "null leaves what there is";
  EXPECT_EQ(pliant_world_set_state(cube, 0, u.data(), nullptr, count - 3), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_set_state(cube, 7, u.data(), nullptr, count), PLIANT_USAGE);
}

}  // namespace
}  // namespace pliant
