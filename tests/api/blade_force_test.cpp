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

/// The edge comes through the side of the block and goes along its top, which has vertices every 4 mm.
World drawn() { return driven("[[0, -0.065, 0.01, 0.003, -0.065, 0.03, 0.003], [0.6, 0.0, 0.01, 0.003, 0.0, 0.03, 0.003]]"); }

TEST(CutAttempts, TellTheWayOverTheSurface) {
  World world = drawn();
  const FramePtr uncut = world.frame();
  std::vector<CutAttempt> all;
  for (int i = 0; i < 12; ++i) {
    world.advance(0.05);
    for (const CutAttempt& a : world.cut_attempts()) all.push_back(a);
  }
  EXPECT_TRUE(world.cut_attempts().empty()) << "each is told once";
  ASSERT_GE(all.size(), 3U);
  const BodyInfo& body = world.info().bodies[0];
  for (const CutAttempt& a : all) {
    EXPECT_EQ(a.blade, "scalpel");
    EXPECT_EQ(a.body, "block");
    EXPECT_NE(a.from, a.to);
    ASSERT_TRUE(static_cast<std::size_t>(a.to) >= body.vertices.first &&
                static_cast<std::size_t>(a.to) < body.vertices.first + body.vertices.count);
    const auto& to = uncut->positions[static_cast<std::size_t>(a.to)];
    const auto& from = uncut->positions[static_cast<std::size_t>(a.from)];
    const auto far = [&](const std::array<float, 4>& v) {
      return std::hypot(a.rest[0] - v[0], a.rest[1] - v[1], a.rest[2] - v[2]);
    };
    EXPECT_NEAR(far(to), far(from), 1e-5) << "it passes from one to the other where both are as near";
    EXPECT_GT(a.time, 0);
    EXPECT_LE(a.time, world.time());
    EXPECT_LT(std::abs(a.position[2] - 0.003), 0.003);
  }
  EXPECT_TRUE(all.back().gave_way);
}

TEST(CutAttempts, AreThoseAfterTheCheckpoint) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pckpt").string();
  World world = drawn(), other = drawn();
  world.advance(0.4);
  EXPECT_FALSE(world.cut_attempts().empty());
  world.save(file);
  other.advance(0.3);
  other.load(file);
  EXPECT_TRUE(other.cut_attempts().empty()) << "those of before it are of another run";
  world.advance(0.19);
  other.advance(0.19);
  const std::vector<CutAttempt> own = world.cut_attempts(), resumed = other.cut_attempts();
  ASSERT_EQ(own.size(), resumed.size());
  EXPECT_FALSE(own.empty());
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].to, resumed[i].to);
    EXPECT_EQ(own[i].time, resumed[i].time);
    EXPECT_EQ(own[i].stroke, resumed[i].stroke);
  }
  world.advance(0.1);
  world.reset();
  EXPECT_TRUE(world.cut_attempts().empty());
  world.advance(0.4);
  EXPECT_FALSE(world.cut_attempts().empty());
}

/// Lifted and placed again a short way beside, the blade begins another stroke.
TEST(CutAttempts, ALiftedBladeBeginsAnotherStroke) {
  World world = driven("[[0, -0.065, 0.01, 0.003, -0.065, 0.03, 0.003]]");
  const auto draw = [&](double z) {
    world.drive_blade("scalpel", {-0.065, 0.01, z}, {-0.065, 0.03, z});
    world.step(1);
    world.drive_blade("scalpel", {-0.048, 0.01, z}, {-0.048, 0.03, z}, 0.2);
    world.advance(0.2);
    return world.cut_attempts();
  };
  const std::vector<CutAttempt> first = draw(0.003);
  ASSERT_FALSE(first.empty());
  world.lift_blade("scalpel");
  const std::vector<CutAttempt> second = draw(0.012);
  ASSERT_FALSE(second.empty());
  for (const CutAttempt& a : second) EXPECT_GT(a.stroke, first.back().stroke);
}

TEST(CutAttempts, InC) {
  const std::string folder = test::source_dir() + "/scenes";
  std::string text = driven_scene;
  text.replace(text.find("PATH"), 4,
               "[[0, -0.065, 0.01, 0.003, -0.065, 0.03, 0.003], [0.6, 0.0, 0.01, 0.003, 0.0, 0.03, 0.003]]");
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text.c_str(), folder.c_str(), nullptr, 0, &options, &world), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(pliant_world_advance(world, 0.59, nullptr), PLIANT_OK) << pliant_last_error();
  World same = drawn();
  same.advance(0.59);
  const std::vector<CutAttempt> expected = same.cut_attempts();
  ASSERT_GE(expected.size(), 3U);
  std::size_t given = 0;
  test::expect_checked<pliant_cut_attempt>(
      PLIANT_CUT_ATTEMPT_INIT, [&](pliant_cut_attempt* a) { return pliant_world_cut_attempts(world, a, 1, &given); });
  std::size_t at = 2;  // the check has taken two
  while (given > 0) {
    pliant_cut_attempt two[2] = {PLIANT_CUT_ATTEMPT_INIT, PLIANT_CUT_ATTEMPT_INIT};
    ASSERT_EQ(pliant_world_cut_attempts(world, two, 2, &given), PLIANT_OK) << pliant_last_error();
    ASSERT_LE(at + given, expected.size());
    for (std::size_t i = 0; i < given; ++i) {
      const CutAttempt& e = expected[at++];
      EXPECT_EQ(two[i].blade, e.blade);
      EXPECT_EQ(two[i].body, e.body);
      EXPECT_EQ(two[i].stroke, e.stroke);
      EXPECT_EQ(two[i].from, e.from);
      EXPECT_EQ(two[i].to, e.to);
      EXPECT_EQ(two[i].time, e.time);
      EXPECT_EQ(two[i].gave_way != 0, e.gave_way);
      EXPECT_TRUE(std::equal(e.position.begin(), e.position.end(), two[i].position));
      EXPECT_TRUE(std::equal(e.rest.begin(), e.rest.end(), two[i].rest));
    }
  }
  EXPECT_EQ(at, expected.size()) << "those that did not fit have waited";
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
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
