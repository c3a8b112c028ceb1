// Tools that a program lets hold tissue, while others come and go.
#include <gtest/gtest.h>

#include "scenes.h"
#include "support/temp_folder.h"
#include "tool_block.h"

namespace pliant::grip_test {
namespace {

using test::ball;
using test::block_with;
using test::code_of;
using test::force_of;
using test::message_of;
using test::on;

/// A program closes forceps, lifts, and opens them; the state in between is in checkpoints.
TEST(Grips, GoOnAndOff) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "held.pck").string();
  ToolSpec forceps = ball("forceps", {0, 0, 0.009});
  forceps.grip.emplace();
  World world(block_with({forceps}), on("cpu"));
  const auto pull = [&](World& w) { return -force_of(w, "forceps").force[2]; };
  const auto lift = [&](World& w) {
    w.drive_tool("forceps", {0, 0, 0.014}, {0, 0, 0, 1}, 0.1);
    w.step(400);
  };
  world.step(50);
  lift(world);
  EXPECT_EQ(pull(world), 0) << "it does not grip yet";
  world.reset();
  world.step(50);
  world.grip_tool("forceps");
  lift(world);
  const double held = pull(world);
  EXPECT_GT(held, 0.1);
  world.save(file);
  world.grip_tool("forceps", false);
  world.step(300);
  EXPECT_EQ(pull(world), 0);
  world.load(file);
  world.step(300);
  EXPECT_NEAR(pull(world), held, 0.02 * held) << "a World that was loaded holds on";
  world.remove_tool("forceps");
  world.step(300);
  world.add_tool(forceps);
  EXPECT_EQ(code_of([&] { world.grip_tool("probe"); }), ErrorCode::usage);
  world.add_tool(ball("probe", {0, 0, 0.02}));
  EXPECT_EQ(message_of([&] { world.grip_tool("probe"); }), "tool \"probe\" has no \"grip\", so it cannot hold tissue");
}

/// Tools before and after it come and go; what one holds stays held.
TEST(Grips, StayWhileToolsComeAndGo) {
  ToolSpec forceps = ball("forceps", {0, 0, 0.009});
  forceps.grip = GripSpec{0, {{0, 1e9}}};
  World world(block_with({ball("first", {0.03, 0.03, 0.02}), forceps}), on("cpu"));
  const auto pull = [&] { return -force_of(world, "forceps").force[2]; };
  world.step(50);
  world.drive_tool("forceps", {0, 0, 0.014}, {0, 0, 0, 1}, 0.1);
  world.step(400);
  const double held = pull();
  EXPECT_GT(held, 0.1);
  const auto expect_held = [&](const char* what) {
    world.step(50);
    EXPECT_NEAR(pull(), held, 0.01 * held) << what;
  };
  world.remove_tool("first");
  expect_held("a tool before it was removed");
  world.add_tool(ball("last", {-0.03, 0.03, 0.02}));
  expect_held("a tool was added");
  world.park_tool("last");
  expect_held("a tool was parked");
  world.place_tool("forceps", {0, 0, 0.03});
  world.step(300);
  EXPECT_EQ(pull(), 0) << "a tool that is placed elsewhere lets go";
}

}  // namespace
}  // namespace pliant::grip_test
