// Grabs and pushes: they do what they say, and stay stable.
#include <cmath>

#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::block;
using test::code_of;
using test::on;

double distance(const Vec4f& a, const Vec3d& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The vertex at the corner (0.1, 0.08, 0.06) of the block.
constexpr std::int32_t kCorner = 7;

TEST(Tools, AGrabBringsTheVertexToItsTarget) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  World world(scene, on("cpu", true));
  GrabOptions options;
  options.radius = 0.025;
  const GrabId grab = world.grab(kCorner, options);
  world.step(100);
  EXPECT_EQ(world.displacements(0).at(0), (Vec3d{}));  // a grab that was not moved does not pull
  const Vec3d target{0.11, 0.09, 0.06};
  world.move_grab(grab, target);
  world.advance(2);
  EXPECT_LT(distance(world.frame()->positions[kCorner], target), 0.001);
  world.release(grab);
  world.advance(5);
  EXPECT_LT(distance(world.frame()->positions[kCorner], {0.1, 0.08, 0.06}), 0.001);
}

TEST(Tools, AGrabArrivesByDefaultInSoftAndStiffTissue) {
  for (const double young : {1e3, 1e4, 1e5}) {
    SceneSpec scene = block(0);
    scene.gravity = {};
    scene.bodies[0].material.young = young;
    World world(scene, on("cpu", true));
    const GrabId grab = world.grab(kCorner);
    EXPECT_EQ(world.grab_state(grab).force, (Vec3d{}));
    const Vec3d target{0.1, 0.12, 0.06};  // half the block's height away
    world.move_grab(grab, target);
    world.advance(3);
    EXPECT_LT(distance(world.frame()->positions[kCorner], target), 0.05 * 0.04) << young;
    const GrabState state = world.grab_state(grab);
    EXPECT_GT(state.force[1], 0) << young;
    EXPECT_FALSE(state.limited) << young;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(state.gap[c], target[c] - world.frame()->positions[kCorner][c], 2e-4) << young;  // as of the last update
    }
  }
}

/// At rest a grab pulls as much as the body is held with.
TEST(Tools, TheForceOfAGrabIsWhatHoldsTheBody) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  ProbeSpec& hold = scene.probes.emplace_back();
  hold.name = "hold";
  hold.where = RegionSpec::plane({0, 0.001, 0}, {0, -1, 0});
  hold.quantities = {"reaction"};
  World world(scene, on("cpu", true));
  const GrabId grab = world.grab(kCorner);
  world.move_grab(grab, {0.1, 0.09, 0.07});
  world.advance(6);
  const GrabState state = world.grab_state(grab);
  const std::vector<double> held = world.probes().at(0).numbers;
  ASSERT_GT(state.force[2], 0.01);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(held[c], -state.force[c], 0.01 * state.force[2]) << c;
}

TEST(Tools, AGrabTellsThatItsForceIsAtTheLimit) {
  World world(block(0), on("cpu", true));
  const GrabId grab = world.grab(kCorner);
  world.move_grab(grab, {0.1, 2, 0.06});
  world.advance(0.5);
  EXPECT_TRUE(world.grab_state(grab).limited);
  EXPECT_GT(world.grab_state(grab).gap[1], 1.5);
  EXPECT_EQ(code_of([&] { (void)world.grab_state(grab + 1); }), ErrorCode::usage);
}

TEST(Tools, AWildGrabDoesNotDiverge) {
  World world(block(0), on("cpu", true));
  const GrabId grab = world.grab(kCorner);
  for (int i = 0; i < 40; ++i) {
    world.move_grab(grab, {0.1 + (i % 2 ? 5 : -5), 0.08 + (i % 3 ? 3 : -3), 0.06});
    ASSERT_FALSE(world.advance(0.02).diverged) << world.wait().message;
  }
}

TEST(Tools, APushIsThatForceOfTheScene) {
  // The same force as a load of the scene: on the nodes of the vertex's cell, at the far corner all on one node.
  SceneSpec loaded = block(0);
  World probe(block(0), on("cpu"));
  const auto rest = probe.rest_positions(0);
  std::int64_t corner = -1;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (std::hypot(rest[n][0] - 0.1, rest[n][1] - 0.08, rest[n][2] - 0.06) < 1e-6) corner = static_cast<std::int64_t>(n);
  }
  ASSERT_GE(corner, 0) << "the lattice has a node at the corner";
  loaded.bodies[0].forces.push_back({RegionSpec::of_nodes({corner}), {0.05, 0.02, 0}, {}});
  World scene(loaded, on("cpu")), pushed(block(0), on("cpu", true)), node(block(0), on("cpu", true));
  pushed.push(kCorner, {0.05, 0.02, 0});
  node.push_node(0, corner, {0.05, 0.02, 0});
  for (World* w : {&scene, &pushed, &node}) w->step(200);
  const auto a = scene.displacements(0), b = pushed.displacements(0), c = node.displacements(0);
  double worst = 0, largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max({worst, std::fabs(a[n][k] - b[n][k]), std::fabs(a[n][k] - c[n][k])});
      largest = std::max(largest, std::fabs(a[n][k]));
    }
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(worst, 5e-3 * largest);  // the first step of a load begins as a parabola, that of a push does not
  pushed.clear_handles();
  pushed.step(1);
}

TEST(Tools, ALoadedWorldHasItsOwnTools) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pckpt").string();
  World world(block(0), on("cpu", true)), without(block(0), on("cpu", true)), with(block(0), on("cpu", true));
  world.push(kCorner, {0.05, 0.02, 0});
  world.step(64);
  world.save(file);
  without.load(file);
  with.push(kCorner, {0.05, 0.02, 0});
  with.load(file);
  world.step(64);
  with.step(64);
  EXPECT_EQ(with.hash(), world.hash());
  world.load(file);
  world.clear_handles();
  world.step(64);
  without.step(64);
  EXPECT_EQ(without.hash(), world.hash()) << "a force of the world that was saved goes on";
  EXPECT_NE(without.hash(), with.hash());
}

TEST(Tools, WorkWhileTheWorkerIsBusyAndOnShapeMatching) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.dt = 0.002;
  scene.bodies[0].model.type = "flsm";
  World world(scene, on("cpu", true));
  ASSERT_TRUE(world.step_async(3000));
  world.push(kCorner, {0.2, 0, 0});
  world.wait();
  ASSERT_TRUE(world.step_async(100));
  world.wait();
  EXPECT_GT(world.frame()->positions[kCorner][0], 0.1F + 1e-5F);
}

TEST(Tools, WhatCannotBeHeldIsRefused) {
  World plain(block(0), on("cpu")), world(block(0), on("cpu", true));
  EXPECT_EQ(test::code_of([&] { plain.grab(0); }), ErrorCode::state);
  EXPECT_EQ(test::code_of([&] { plain.push(0, {1, 0, 0}); }), ErrorCode::state);
  EXPECT_EQ(test::code_of([&] { world.grab(8); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.grab(-1); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.grab(0, {-1, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.push(0, {NAN, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.push_node(1, 0, {1, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.push_node(0, 1 << 20, {1, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(test::code_of([&] { world.release(17); }), ErrorCode::usage);
  const GrabId grab = world.grab(0);
  world.release(grab);
  EXPECT_EQ(test::code_of([&] { world.move_grab(grab, {}); }), ErrorCode::usage);
}

}  // namespace
}  // namespace pliant
