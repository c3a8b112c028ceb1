// Blades that cut by force in a World: the program moves them and reads what they feel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "c_struct_checks.h"
#include "pliant/c/pliant.h"
#include "pliant/error.h"
#include "pliant/world.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

TEST(BladeForce, IsTracedStepByStep) {
  WorldOptions options;
  options.backend = "cpu";
  World world = World::open(test::source_dir() + "/scenes/incise.json", options);
  EXPECT_TRUE(world.force_trace("scalpel").empty());
  EXPECT_THROW(static_cast<void>(world.force_trace("knife")), Error);
  world.step(150);
  const std::vector<ForceSample> trace = world.force_trace("scalpel");
  ASSERT_GT(trace.size(), 50U);
  EXPECT_GT(trace.back().force[1], 1);
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_EQ(trace[i].step, trace[i - 1].step + 1);
}

/// A blade that waits for the program: it presses, gives way, and is what the same blade on a path is.
constexpr const char* driven_scene = R"({"format": "pliant-scene/1", "bodies": [{"name": "block", "surface": "meshes/block.obj",
  "lattice": {"spacing": 0.01}, "element": "hex8", "material": {"law": "neo-hookean", "young": 20000, "poisson": 0.4,
  "density": 1000, "damping": 60, "toughness": 40000}, "fixed": [{"box": [[-1, -0.0201, -1], [1, -0.0199, 1]]}]}],
  "blades": [{"name": "scalpel", "cuts": "by-force", "edge": 5e-4, "path": PATH}]})";
const Vec3d above_a{0, 0.025, -0.06}, above_b{0, 0.025, 0.06}, deep_a{0, 0.005, -0.06}, deep_b{0, 0.005, 0.06};

World driven(const std::string& path = "[[0, 0, 0.025, -0.06, 0, 0.025, 0.06]]") {
  WorldOptions options;
  options.backend = "cpu";
  std::string text = driven_scene;
  text.replace(text.find("PATH"), 4, path);
  return World::parse(text, test::source_dir() + "/scenes", options);
}

BladeForce scalpel(const World& world) { return world.blade_forces().at(0); }

TEST(BladeForce, OfADrivenBladeIsThatOfABladeOnAPath) {
  World host = driven(), path = driven("[[0, 0, 0.025, -0.06, 0, 0.025, 0.06], [0.4, 0, 0.005, -0.06, 0, 0.005, 0.06]]");
  host.advance(0.02);
  EXPECT_TRUE(scalpel(host).present);
  EXPECT_EQ(scalpel(host).force, Vec3d{});
  host.drive_blade("scalpel", deep_a, deep_b, 0.4);
  double before = 0, most = 0;
  for (int i = 0; i < 37; ++i) {
    host.advance(0.01);
    path.advance(0.01);
    const double a = scalpel(host).force[1], b = scalpel(path).force[1];
    if (scalpel(host).gave_way < 0) most = std::max(most, std::abs(a - b)), before = std::max(before, b);
  }
  EXPECT_GT(before, 1);
  EXPECT_LT(most, 0.05 * before);
  EXPECT_NEAR(scalpel(host).max_force, scalpel(path).max_force, 0.05 * before);
  EXPECT_NEAR(scalpel(host).gave_way, scalpel(path).gave_way + 0.02, 0.01);
  EXPECT_GT(scalpel(host).work, scalpel(host).fracture);
  EXPECT_GT(scalpel(host).fracture, 0);
  bool told = false;
  for (const Event& e : host.events()) told = told || (e.kind == "gave_way" && e.subject == "scalpel" && e.amount > 1);
  EXPECT_TRUE(told);
}

TEST(BladeForce, LiftedItIsNowhereAndMayBeginAnywhere) {
  World world = driven();
  world.drive_blade("scalpel", deep_a, deep_b, 0.2);
  world.advance(0.1);
  EXPECT_TRUE(scalpel(world).pressing);
  world.lift_blade("scalpel");
  EXPECT_FALSE(scalpel(world).present);
  world.advance(0.05);
  EXPECT_FALSE(scalpel(world).pressing);
  EXPECT_EQ(scalpel(world).force, Vec3d{});
  world.drive_blade("scalpel", {0.02, 0.025, -0.05}, {0.02, 0.025, 0.05});
  EXPECT_EQ(scalpel(world).a, (Vec3d{0.02, 0.025, -0.05}));
}

/// A place ahead of where it was lifted is not the way of its front.
TEST(BladeForce, LiftedAndPlacedAheadItDoesNotCutTheWay) {
  World world = driven();
  world.drive_blade("scalpel", {0, 0.017, -0.06}, {0, 0.017, 0.06}, 0.1);
  world.advance(0.1);
  ASSERT_TRUE(scalpel(world).pressing);
  const double work = scalpel(world).work, most = scalpel(world).max_force;
  world.lift_blade("scalpel");
  EXPECT_FALSE(scalpel(world).pressing);
  EXPECT_EQ(scalpel(world).force, Vec3d{});
  world.drive_blade("scalpel", deep_a, deep_b);
  world.step(1);
  world.advance(0.05);
  EXPECT_EQ(scalpel(world).fracture, 0);
  EXPECT_EQ(scalpel(world).work, work);
  EXPECT_EQ(scalpel(world).max_force, most);
}

TEST(BladeForce, IsPartOfCheckpointsAndResets) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pckpt").string();
  World world = driven(), other = driven();
  world.advance(0.02);
  world.drive_blade("scalpel", deep_a, deep_b, 0.4);
  world.advance(0.15);
  world.save(file);
  other.load(file);
  EXPECT_EQ(scalpel(other).a, scalpel(world).a);
  world.step(200);
  other.step(200);
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_GT(scalpel(world).max_force, 1);
  EXPECT_EQ(scalpel(other).work, scalpel(world).work);
  world.reset();
  EXPECT_EQ(scalpel(world).a, above_a);
  EXPECT_EQ(scalpel(world).max_force, 0);
}

TEST(BladeForce, TheWorkerDrives) {
  World world = driven(), other = driven();
  const auto go = [](World& w, bool asynchronous) {
    for (int i = 0; i < 20; ++i) {
      const double share = (i + 1) / 20.0;
      const Vec3d a{0, above_a[1] + share * (deep_a[1] - above_a[1]), above_a[2]}, b{0, a[1], above_b[2]};
      w.drive_blade("scalpel", a, b);
      if (asynchronous) {
        w.advance_async(1.0 / 60);
        w.wait();
      } else {
        w.advance(1.0 / 60);
      }
    }
  };
  go(world, false);
  go(other, true);
  EXPECT_EQ(world.hash(), other.hash());
  EXPECT_GT(scalpel(other).max_force, 1);
}

/// A blade with faces that the program drives through the block: they hold the cut open until it is lifted, and are no tools.
TEST(BladeForce, FacesComeAndGoWithTheBlade) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pckpt").string();
  std::string text = driven_scene;
  text.replace(text.find("PATH"), 4, "[[0, 0, 0.025, -0.06, 0, 0.025, 0.06]]");
  text.replace(text.find("\"edge\""), 0, R"("thickness": 0.003, "height": 0.04, "back": [0, 1, 0], )");
  WorldOptions options;
  options.backend = "cpu";
  World world = World::parse(text, test::source_dir() + "/scenes", options);
  World other = World::parse(text, test::source_dir() + "/scenes", options);
  EXPECT_TRUE(world.tool_forces().empty());
  EXPECT_THROW(world.park_tool("scalpel (face 1)"), Error);
  world.drive_blade("scalpel", {0, -0.01, -0.06}, {0, -0.01, 0.06}, 0.5);
  world.advance(0.55);
  const BladeForce in = scalpel(world);
  EXPECT_GT(in.face_normal, 0.1);
  EXPECT_GT(in.face_work, 0);
  EXPECT_GT(in.work, in.face_work);
  EXPECT_NE(in.face_force, Vec3d{});
  world.save(file);
  other.load(file);
  EXPECT_EQ(other.hash(), world.hash());
  world.step(50);
  other.step(50);
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_EQ(scalpel(other).face_normal, scalpel(world).face_normal);
  world.lift_blade("scalpel");
  world.advance(0.05);
  EXPECT_EQ(scalpel(world).face_normal, 0);
  EXPECT_EQ(scalpel(world).force, Vec3d{});
  EXPECT_GE(scalpel(world).face_work, in.face_work);
  // Where it comes again, tissue that has closed is spread, not thrown off.
  world.drive_blade("scalpel", {0, -0.01, -0.06}, {0, -0.01, 0.06});
  double fastest = 0;
  for (int i = 0; i < 20; ++i) {
    world.advance(0.01);
    for (const Vec3d& v : world.velocities(0)) fastest = std::max(fastest, std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  EXPECT_GT(scalpel(world).face_normal, 0.05);
  EXPECT_LT(fastest, 0.5);
}

TEST(BladeForce, WhatCannotBeIsOneMessage) {
  World world = driven();
  const std::uint64_t before = world.hash();
  const auto message = [&](const std::string& name, const Vec3d& a, const Vec3d& b, double seconds) -> std::string {
    try {
      world.drive_blade(name, a, b, seconds);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("knife", deep_a, deep_b, 1).find("'scalpel'"), std::string::npos);
  EXPECT_NE(message("scalpel", deep_a, deep_a, 1).find("two different"), std::string::npos);
  EXPECT_NE(message("scalpel", deep_a, deep_b, -1).find("not negative"), std::string::npos);
  EXPECT_NE(message("scalpel", {0, NAN, 0}, deep_b, 1).find("finite"), std::string::npos);
  EXPECT_NE(message("scalpel", {0, 0.005, -0.1}, {0, 0.005, 0.1}, 1).find("its length on its path"), std::string::npos);
  EXPECT_NE(message("scalpel", deep_a, deep_b, 0.001).find("m/s"), std::string::npos);
  EXPECT_THROW(world.move_blade("scalpel", deep_a, deep_b), Error) << "drive_blade() moves it";
  EXPECT_EQ(scalpel(world).a, above_a);
  EXPECT_EQ(world.hash(), before);
}

TEST(BladeForce, InC) {
  const std::string folder = test::source_dir() + "/scenes";
  std::string text = driven_scene;
  text.replace(text.find("PATH"), 4, "[[0, 0, 0.025, -0.06, 0, 0.025, 0.06]]");
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text.c_str(), folder.c_str(), nullptr, 0, &options, &world), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(pliant_world_drive_blade(world, "scalpel", deep_a.data(), deep_b.data(), 0.2), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(pliant_world_drive_blade(world, "knife", deep_a.data(), deep_b.data(), 0.2), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_advance(world, 0.1, nullptr), PLIANT_OK) << pliant_last_error();
  test::expect_checked<pliant_blade_force>(
      PLIANT_BLADE_FORCE_INIT, [&](pliant_blade_force* f) { return pliant_world_blade_forces(world, f, 1, nullptr); });
  pliant_blade_force force = PLIANT_BLADE_FORCE_INIT;
  std::size_t count = 0;
  EXPECT_EQ(pliant_world_blade_forces(world, &force, 1, &count), PLIANT_OK);
  EXPECT_EQ(count, 1U);
  EXPECT_STREQ(force.name, "scalpel");
  EXPECT_GT(force.force[1], 1);
  EXPECT_GT(force.work, 0);
  EXPECT_EQ(force.present + force.pressing, 2);
  EXPECT_NEAR(force.a[1], 0.015, 1e-3);
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
}

}  // namespace
}  // namespace pliant
