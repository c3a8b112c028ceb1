// Rigid tools that come, go, are parked and put elsewhere while a World runs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "c_world.h"
#include "scenes.h"
#include "support/temp_folder.h"
#include "tool_block.h"

namespace pliant {
namespace {

using test::ball;
using test::bare_block;
using test::block_with;
using test::code_of;
using test::force_of;
using test::message_of;
using test::on;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(ToolChanges, AnAddedToolIsAToolOfTheScene) {
  World with(block_with({ball("probe", {0, 0, 0.0105})}), on("cpu")), added(bare_block(), on("cpu"));
  EXPECT_EQ(added.tool_forces().size(), 0u);
  for (World* w : {&with, &added}) w->step(37);
  EXPECT_EQ(added.add_tool(ball("probe", {0, 0, 0.0105})), "probe");
  EXPECT_EQ(force_of(added, "probe").position, (Vec3d{0, 0, 0.0105}));
  for (World* w : {&with, &added}) {
    w->drive_tool("probe", {0.01, 0, 0.006}, {0, 0, 0, 1}, 0.2);
    w->step(400);
  }
  EXPECT_GT(force_of(with, "probe").force[2], 0.1);
  EXPECT_EQ(force_of(with, "probe").force, force_of(added, "probe").force);
  EXPECT_EQ(with.hash(), added.hash());
}

TEST(ToolChanges, WhatIsRemovedOrParkedTouchesNothingAndLeavesNoTrace) {
  World bare(bare_block(), on("cpu")), removed(block_with({ball("a", {0, 0, 0.02})}), on("cpu")),
      parked(block_with({ball("a", {0, 0, 0.02})}), on("cpu"));
  removed.remove_tool("a");
  parked.park_tool("a");
  EXPECT_EQ(removed.tool_forces().size(), 0u);
  EXPECT_TRUE(force_of(parked, "a").parked);
  for (World* w : {&bare, &removed, &parked}) w->step(100);
  EXPECT_EQ(bare.hash(), removed.hash());
  EXPECT_EQ(bare.hash(), parked.hash());
  EXPECT_EQ(WorldAccess::simulation(parked).program().step.size(), WorldAccess::simulation(bare).program().step.size())
      << "a parked tool costs passes";
  EXPECT_EQ(test::code_of([&] { removed.drive_tool("a", {}, {0, 0, 0, 1}, 1); }), ErrorCode::usage);
  EXPECT_EQ(removed.add_tool(ball("a", {0, 0, 0.03})), "a") << "the name is free again";
  EXPECT_EQ(force_of(removed, "a").position, (Vec3d{0, 0, 0.03}));
}

TEST(ToolChanges, AParkedToolLetsGoAndComesBack) {
  World world(block_with({ball("a", {-0.02, 0, 0.0105}), ball("b", {0.02, 0, 0.0105})}), on("cpu"));
  world.drive_tool("a", {-0.02, 0, 0.006}, {0, 0, 0, 1}, 0.1);
  world.drive_tool("b", {0.02, 0, 0.006}, {0, 0, 0, 1}, 0.1);
  world.advance(0.5);
  const Vec3d pressed = force_of(world, "b").force;
  const double first = force_of(world, "a").force[2];
  ASSERT_GT(first, 0.1);
  world.park_tool("a");
  EXPECT_EQ(force_of(world, "a").force, Vec3d{});
  EXPECT_EQ(force_of(world, "b").force, pressed) << "what the other one felt goes on with it";
  world.advance(0.5);
  EXPECT_GT(force_of(world, "b").force[2], 0.9 * pressed[2]);
  const std::string inside = message_of([&] { world.unpark_tool("a"); });
  EXPECT_TRUE(has(inside, "tool 'a' begins inside body 'block'") && has(inside, "a quarter of a cell")) << inside;
  EXPECT_TRUE(force_of(world, "a").parked);
  world.place_tool("a", {-0.02, 0, 0.0105});
  EXPECT_FALSE(force_of(world, "a").parked);
  world.park_tool("a");
  world.park_tool("a");
  world.drive_tool("a", {-0.02, 0, 0.006}, {0, 0, 0, 1}, 0.1);
  EXPECT_FALSE(force_of(world, "a").parked);
  world.advance(0.5);
  EXPECT_NEAR(force_of(world, "a").force[2], first, 1e-3 * first);
}

TEST(ToolChanges, FrictionOfToolsThatStayGoesOn) {
  // What sticks to b sticks to it after a has gone, and b has another number.
  const std::vector<ToolSpec> both = {ball("a", {-0.02, 0, 0.03}), ball("b", {0.02, 0, 0.0105})};
  World alone(block_with({both[1]}), on("cpu")), world(block_with(both), on("cpu"));
  for (World* w : {&alone, &world}) {
    w->drive_tool("b", {0.02, 0, 0.006}, {0, 0, 0, 1}, 0.1);
    w->step(300);
    w->drive_tool("b", {0.022, 0, 0.006}, {0, 0, 0, 1}, 0.1);
    w->step(64);
  }
  ASSERT_EQ(alone.hash(), world.hash());
  world.remove_tool("a");
  for (World* w : {&alone, &world}) w->step(200);
  EXPECT_EQ(alone.hash(), world.hash());
  EXPECT_LT(force_of(world, "b").force[0], -0.01) << "it does not stick";
  EXPECT_EQ(force_of(alone, "b").force, force_of(world, "b").force);
}

TEST(ToolChanges, AToolThatIsPlacedElsewhereLetsGo) {
  ToolSpec tool = ball("a", {0, 0, 0.0105});
  tool.friction = 0.8;
  World world(block_with({tool}), on("cpu"));
  world.drive_tool("a", {0, 0, 0.008}, {0, 0, 0, 1}, 0.1);
  world.advance(0.5);
  world.place_tool("a", {0.003, 0, 0.008});
  world.advance(0.5);
  const Vec3d placed = force_of(world, "a").force;
  EXPECT_GT(placed[2], 0.05);
  EXPECT_LT(std::abs(placed[0]), 0.1 * placed[2]) << "it still holds what it touched before";
  world.drive_tool("a", {0.006, 0, 0.008}, {0, 0, 0, 1}, 0.1);
  world.advance(0.5);
  EXPECT_LT(force_of(world, "a").force[0], -0.2 * placed[2]) << "one that is drawn does not";
}

TEST(ToolChanges, WhatIsInsideOrInTheWayIsRefusedAndNothingChanges) {
  World world(block_with({ball("a", {0, 0, 0.02})}), on("cpu"));
  world.step(20);
  const std::uint64_t before = WorldAccess::simulation(world).deep_hash();
  const auto refused = [&](auto&& call, const std::string& part) {
    EXPECT_EQ(code_of(call), ErrorCode::input);
    const std::string message = message_of(call);
    EXPECT_TRUE(has(message, part)) << message;
    EXPECT_EQ(WorldAccess::simulation(world).deep_hash(), before) << message;
  };
  refused([&] { world.add_tool(ball("b", {0, 0, 0.005})); }, "tool 'b' begins inside body 'block', 0.00");
  refused([&] { world.add_tool(ball("b", {0, 0, -0.02}, 0.001)); }, "inside body 'block'");  // wholly inside
  ToolSpec needle = ball("b", {0, 0, 0}, 1e-4);
  needle.shape = "capsule";
  needle.first = {0.005, 0.005, 0.05};
  needle.second = {0.005, 0.005, -0.012};
  refused([&] { world.add_tool(needle); }, "inside body 'block'");  // between the points of the tissue
  refused([&] { world.place_tool("a", {0, 0, 0.001}); }, "begins inside");
  refused([&] { world.drive_tool("a", {0, 0, 0.001}, {0, 0, 0, 1}, 1e-3); }, "in its way");
  refused([&] { world.drive_tool("a", {0, 0, -0.2}, {0, 0, 0, 1}, 1e-3); }, "100 cells per second");  // out on the other side
  EXPECT_EQ(force_of(world, "a").position, (Vec3d{0, 0, 0.02}));
  world.drive_tool("a", {0, 0, 5}, {0, 0, 0, 1}, 1e-3);  // fast, and nothing is there
  world.drive_tool("a", {0.005, 0, 0.0105}, {0, 0, 0, 1}, 1e-3);
  world.place_tool("a", {0, 0, -0.06});  // through the block: it is not on any way
  world.step(1);
  EXPECT_EQ(force_of(world, "a").position, (Vec3d{0, 0, -0.06}));
}

TEST(ToolChanges, ACheckpointHasThem) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "tools.pckpt").string(), obj = (folder.path() / "wedge.obj").string();
  std::ofstream(obj) << "v -0.01 -0.01 0\nv 0.01 -0.01 0\nv 0 0.01 0\nv 0 0 0.02\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const SceneSpec scene = block_with({ball("a", {0, 0, 0.03}), ball("b", {0.02, 0, 0.0105}), ball("c", {-0.03, 0, 0.0105})});
  World first(scene, on("cpu"));
  first.step(30);
  first.remove_tool("a");
  first.park_tool("c");
  ToolSpec wedge = ball("wedge", {-0.01, 0, 0.0005});
  wedge.shape = "mesh";
  wedge.mesh = obj;
  wedge.edges = true;
  first.add_tool(wedge);
  first.add_tool(ball("", {0, 0.02, 0.0105}));
  first.drive_tool("b", {0.02, 0, 0.006}, {0, 0, 0, 1}, 0.1);
  first.drive_tool("tool0", {0, 0.02, 0.008}, {0, 0, 0, 1}, 0.1);
  first.drive_tool("wedge", {-0.01, 0, -0.003}, {0, 0, 0, 1}, 0.1);
  first.save(file);
  World at_once(scene, on("cpu"));
  at_once.load(file);
  EXPECT_EQ(WorldAccess::simulation(first).deep_hash(), WorldAccess::simulation(at_once).deep_hash());
  for (World* w : {&first, &at_once}) w->step(51);
  first.save(file);
  World later(scene, on("cpu"));
  later.add_tool(ball("other", {0, 0, 0.05}));  // what it has is over
  later.load(file);
  for (World* w : {&first, &at_once, &later}) w->step(149);
  EXPECT_GT(force_of(first, "wedge").force[2], 0.01);
  EXPECT_GT(force_of(first, "tool0").force[2], 0.01);
  for (World* w : {&at_once, &later}) {
    EXPECT_EQ(first.hash(), w->hash());
    EXPECT_EQ(WorldAccess::simulation(first).deep_hash(), WorldAccess::simulation(*w).deep_hash());
    ASSERT_EQ(w->tool_forces().size(), 4u);
    for (std::size_t t = 0; t < 4; ++t) {
      EXPECT_EQ(first.tool_forces()[t].name, w->tool_forces()[t].name);
      EXPECT_EQ(first.tool_forces()[t].force, w->tool_forces()[t].force);
    }
    EXPECT_TRUE(force_of(*w, "c").parked);
  }
  later.reset();
  EXPECT_EQ(later.tool_forces().size(), 3u);
  EXPECT_FALSE(force_of(later, "c").parked);
  later.step(10);
}

TEST(ToolChanges, BesideAWorkerTheyAreQueued) {
  World world(bare_block(), on("cpu"));
  ASSERT_TRUE(world.step_async(3000));
  EXPECT_EQ(world.add_tool(ball("probe", {0, 0, 0.0105})), "probe");
  EXPECT_EQ(world.add_tool(ball("", {0.03, 0, 0.02})), "tool0");
  EXPECT_EQ(code_of([&] { world.add_tool(ball("probe", {0, 0, 0.05})); }), ErrorCode::usage);
  world.drive_tool("probe", {0, 0, 0.006}, {0, 0, 0, 1}, 0.05);
  world.remove_tool("tool0");
  EXPECT_EQ(code_of([&] { world.park_tool("tool0"); }), ErrorCode::usage);
  world.wait();
  ASSERT_TRUE(world.step_async(500));
  world.wait();
  EXPECT_EQ(world.tool_forces().size(), 1u);
  EXPECT_GT(force_of(world, "probe").force[2], 0.1);
  ASSERT_TRUE(world.step_async(10));
  world.add_tool(ball("bad", {0, 0, -0.01}));
  const std::string message = message_of([&] {
    world.wait();
    ASSERT_TRUE(world.step_async(10));
    world.wait();
  });
  EXPECT_TRUE(has(message, "tool 'bad' begins inside body 'block'")) << message;
  EXPECT_EQ(world.add_tool(ball("bad", {0, 0, 0.05})), "bad") << "the refused one is not there";
}

TEST(ToolChanges, AreReadFromAnotherThreadWhileTheWorkerMakesThem) {
  World world(bare_block(), on("cpu"));
  for (int i = 0; i < 40; ++i) {
    world.step_async(20);
    const std::string name = "t" + std::to_string(i);
    world.add_tool(ball(name, {0, 0, 0.02 + 0.001 * i}));
    world.drive_tool(name, {0, 0.01, 0.02}, {0, 0, 0, 1}, 0.1);
    if (i % 3 == 0) world.park_tool(name);
    if (i > 3) world.remove_tool("t" + std::to_string(i - 4));
    for (const ToolForce& f : world.tool_forces()) EXPECT_FALSE(f.name.empty());
  }
  world.wait();
  world.step(1);
  EXPECT_EQ(world.tool_forces().size(), 4u);
}

TEST(ToolChanges, InC) {
  const test::CCube world;
  const char* const plate = R"({"shape": {"half_space": [[0, 0, 0], [0, 0, -1]]}, "path": [[0, 0, 0, 0.05]]})";
  char name[16] = "";
  EXPECT_EQ(pliant_world_parse_tool(world, nullptr, nullptr, name, sizeof name), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_parse_tool(world, plate, nullptr, nullptr, 16), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_parse_tool(world, "{", nullptr, name, sizeof name), PLIANT_INPUT);
  ASSERT_EQ(pliant_world_parse_tool(world, plate, nullptr, name, sizeof name), PLIANT_OK) << pliant_last_error();
  EXPECT_STREQ(name, "tool0");
  char three[3] = "";
  ASSERT_EQ(pliant_world_parse_tool(world, plate, nullptr, three, sizeof three), PLIANT_OK);
  EXPECT_STREQ(three, "to");
  ASSERT_EQ(pliant_world_remove_tool(world, "tool1"), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(pliant_world_remove_tool(world, "tool1"), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_park_tool(world, nullptr), PLIANT_USAGE);
  ASSERT_EQ(pliant_world_park_tool(world, "tool0"), PLIANT_OK);
  pliant_tool_force force = PLIANT_TOOL_FORCE_INIT;
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_tool_forces(world, &force, 1, &needed), PLIANT_OK);
  EXPECT_EQ(needed, 1U);
  EXPECT_EQ(force.parked, 1);
  ASSERT_EQ(pliant_world_unpark_tool(world, "tool0"), PLIANT_OK);
  const double inside[3] = {0, 0, 0.02}, touching[3] = {0, 0, 0.038}, turn[4] = {0, 0, 0, 1};
  EXPECT_EQ(pliant_world_place_tool(world, "tool0", inside, turn), PLIANT_INPUT);
  EXPECT_EQ(pliant_world_place_tool(world, "tool0", nullptr, turn), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_place_tool(world, "tool0", touching, nullptr), PLIANT_USAGE);
  ASSERT_EQ(pliant_world_place_tool(world, "tool0", touching, turn), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(pliant_world_step(world, 300, nullptr), PLIANT_OK);
  ASSERT_EQ(pliant_world_tool_forces(world, &force, 1, &needed), PLIANT_OK);
  EXPECT_EQ(force.parked, 0);
  EXPECT_GT(force.force[2], 0.1);
}

TEST(ToolChanges, MisuseIsRefused) {
  World world(block_with({ball("a", {0, 0, 0.02})}), on("cpu"));
  EXPECT_EQ(code_of([&] { world.add_tool(ball("a", {0, 0, 0.05})); }), ErrorCode::usage);
  EXPECT_TRUE(has(message_of([&] { world.remove_tool("b"); }), "there is no tool \"b\"; there are \"a\""));
  EXPECT_EQ(code_of([&] { world.park_tool("b"); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.unpark_tool("b"); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.place_tool("b", {}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.place_tool("a", {NAN, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.place_tool("a", {}, {0, 0, 0, 2}); }), ErrorCode::usage);
  ToolSpec bad = ball("b", {0, 0, 0.05});
  bad.shape = "cone";
  EXPECT_TRUE(has(message_of([&] { world.add_tool(bad); }), "/shape: got \"cone\", expected"));
  bad = ball("b", {0, 0, 0.05}, -1);
  EXPECT_TRUE(has(message_of([&] { world.add_tool(bad); }), "tool \"b\": /shape/sphere: got -1"))
      << message_of([&] { world.add_tool(bad); });
  bad.shape = "mesh";
  bad.mesh = "not_there.obj";
  EXPECT_EQ(code_of([&] { world.add_tool(bad); }), ErrorCode::input);
  EXPECT_TRUE(
      has(message_of([&] { world.parse_tool(R"({"shape": {"sphere": 0.01}, "radius": 1})"); }), "unknown key \"radius\""));
  for (int i = 0; i < 28; ++i) world.add_tool(ball("", {0, 0, 0.05}));
  EXPECT_TRUE(has(message_of([&] { world.add_tool(ball("", {0, 0, 0.05})); }), "at most 29"));
  SceneSpec relaxed = bare_block();
  relaxed.relaxation = RelaxationSpec{};
  World still(relaxed, on("cpu"));
  EXPECT_TRUE(has(message_of([&] { still.add_tool(ball("a", {0, 0, 0.05})); }), "relaxation"));
  SceneSpec hybrid = bare_block();
  hybrid.bodies[0].model.type = "hybrid";
  hybrid.bodies[0].model.substeps = 0;  // automatic: several, as there is no tool
  World several(hybrid, on("cpu"));
  EXPECT_TRUE(has(message_of([&] { several.add_tool(ball("a", {0, 0, 0.05})); }), "substeps"));
  hybrid.tools = {ball("first", {0, 0, 0.02})};
  World single(hybrid, on("cpu"));
  EXPECT_EQ(single.add_tool(ball("a", {0, 0, 0.05})), "a");
}

TEST(ToolChanges, ACutLeavesThem) {
  World world(bare_block(), on("cpu"));
  world.add_tool(ball("a", {0, 0, 0.0105}));
  world.drive_tool("a", {0, 0, 0.007}, {0, 0, 0, 1}, 0.1);
  world.step(100);
  EXPECT_TRUE(world.cut({{{Vec3d{0.015, -1, -0.02}, Vec3d{0.015, 1, -0.02}, Vec3d{0.015, 0, 1}}}}).changed);
  world.add_tool(ball("b", {0.03, 0, 0.0105}));
  world.drive_tool("b", {0.03, 0, 0.007}, {0, 0, 0, 1}, 0.1);
  world.advance(0.3);
  EXPECT_GT(force_of(world, "a").force[2], 0.05);
  EXPECT_GT(force_of(world, "b").force[2], 0.05);
  const test::TempFolder folder;
  const std::string file = (folder.path() / "cut.pckpt").string();
  world.save(file);
  World other(bare_block(), on("cpu"));
  other.load(file);
  for (World* w : {&world, &other}) w->step(100);
  EXPECT_EQ(WorldAccess::simulation(world).deep_hash(), WorldAccess::simulation(other).deep_hash());
}

}  // namespace
}  // namespace pliant
