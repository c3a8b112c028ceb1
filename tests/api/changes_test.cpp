// Parameters of a World that change while it runs: at once, beside the caller, in the scene, in checkpoints, and in C.
#include <gtest/gtest.h>

#include <algorithm>

#include "c_world.h"
#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::code_of;
using test::message_of;
using test::on;

/// A block of 40 mm in memory that stands on its foot.
SceneSpec standing() {
  SceneSpec scene;
  scene.gravity = {0, 0, -9.81};
  BodySpec& body = scene.bodies.emplace_back();
  body.name = "block";
  body.surface = box_surface({-0.02, -0.02, 0}, {0.02, 0.02, 0.04});
  body.lattice_spacing = 0.01;
  body.material.young = 1e4;
  body.material.damping = 80;
  body.fixed = {{RegionSpec::box({-1, -1, -0.001}, {1, 1, 0.001}), "xyz"}};
  return scene;
}

double lowest(World& world) {
  double z = 0;
  for (const Vec3d& u : world.displacements(0)) z = std::min(z, u[2]);
  return z;
}

TEST(WorldChanges, SofterTissueSagsFurther) {
  World world(standing(), on("cpu"));
  world.advance(0.5);
  const double before = lowest(world);
  ChangeSpec softer;
  softer.material = MaterialSpec{};
  softer.material->young = 5e3;
  softer.material->damping = 80;
  world.change(softer);
  world.advance(0.5);
  EXPECT_NEAR(lowest(world) / before, 2, 0.1);
  ChangeSpec weightless;
  weightless.gravity = Vec3d{};
  world.change(weightless);
  world.advance(0.6);
  EXPECT_LT(std::abs(lowest(world)), 0.01 * std::abs(before));
  world.reset();
  world.advance(0.5);
  EXPECT_NEAR(lowest(world), before, 1e-9) << "reset goes back to the scene";
}

TEST(WorldChanges, BeforeTheFirstStepTheyAreTheScene) {
  SceneSpec weightless = standing();
  weightless.gravity = {};
  weightless.bodies[0].material.damping = 30;
  ChangeSpec change;
  change.gravity = Vec3d{};
  change.damping = 30;
  for (const double push : {0.0, 0.3}) {
    SceneSpec from = standing(), of = weightless;
    for (SceneSpec* scene : {&from, &of}) {
      scene->dt = 1e-3;
      if (push > 0) scene->bodies[0].forces.push_back({RegionSpec::box({-1, -1, 0.039}, {1, 1, 0.041}), {push, 0, 0}, {}});
    }
    World changed(from, on("cpu")), scene(of, on("cpu"));
    changed.change(change);
    for (World* w : {&changed, &scene}) w->step(50);
    EXPECT_EQ(changed.hash(), scene.hash()) << push;
    EXPECT_EQ(lowest(scene) == 0, push == 0);
  }
}

TEST(WorldChanges, NowBesideTheCallerAndInTheSceneAreOne) {
  ChangeSpec change;
  change.damping = 20;
  change.fixed.emplace();
  World now(standing(), on("cpu")), worker(standing(), on("cpu"));
  for (World* w : {&now, &worker}) w->step(64);
  now.change(change);
  now.step(64);
  ASSERT_TRUE(worker.step_async(0));
  worker.change(change);
  worker.wait();
  ASSERT_TRUE(worker.step_async(64));
  worker.wait();
  EXPECT_EQ(now.hash(), worker.hash());
  SceneSpec scene = standing();
  change.time = 64 * World(standing(), on("cpu")).dt();
  scene.changes = {change};
  World written(scene, on("cpu"));
  written.step(128);
  EXPECT_EQ(now.hash(), written.hash());
  EXPECT_LT(lowest(now), -1e-4) << "it was let go, and falls";
}

TEST(WorldChanges, ACheckpointHasThem) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "changed.pckpt").string();
  World world(standing(), on("cpu"));
  world.step(50);
  world.parse_change(R"({"material": {"young": 20000}})");
  world.step(10);
  world.save(file);
  world.step(50);
  World other(standing(), on("cpu"));
  other.load(file);
  other.step(50);
  EXPECT_EQ(other.hash(), world.hash());
  other.parse_change(R"({"material": {"poisson": 0.3}})");
  world.parse_change(R"({"material": {"poisson": 0.3}})");
  for (World* w : {&world, &other}) w->step(20);
  EXPECT_EQ(other.hash(), world.hash()) << "what changes next builds on it";
}

TEST(WorldChanges, WhatIsRefusedChangesNothing) {
  World world(standing(), on("cpu"));
  world.step(20);
  const std::uint64_t before = world.hash();
  for (const char* text :
       {"", "{}", R"({"material": {"young": 0}})", R"({"body": "bloc", "fixed": []})", R"({"gravity": "up"})",
        R"({"fixed": [{"box": [[7, 7, 7], [8, 8, 8]]}]})", R"({"model": {"alpha": 0.5}})"}) {
    EXPECT_EQ(code_of([&] { world.parse_change(text); }), ErrorCode::input) << text;
  }
  EXPECT_EQ(world.hash(), before);
  EXPECT_NE(message_of([&] { world.parse_change(R"({"body": "bloc", "fixed": []})"); }).find("block"), std::string::npos);
  world.step(20);
}

TEST(WorldChanges, InC) {
  const test::CCube world;
  EXPECT_EQ(pliant_world_parse_change(world, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_parse_change(world, R"({"material": {"young": -1}})"), PLIANT_INPUT);
  EXPECT_EQ(pliant_world_parse_change(world, R"({"gravity": [0, 0, -9.81]})"), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(pliant_world_advance(world, 0.1, nullptr), PLIANT_OK);
}

}  // namespace
}  // namespace pliant
