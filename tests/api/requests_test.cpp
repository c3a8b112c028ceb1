// What a caller asks for around save(), load() and reset(): before, between and after them.
#include "api/requests.h"

#include <gtest/gtest.h>

#include "live.h"
#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using namespace live_test;
using test::block;
using test::message_of;
using test::on;
using Ints = std::vector<int>;

Ints taken(api::Requests<int>& requests) { return requests.take(); }

TEST(Requests, WaitForASaveInTurn) {
  api::Requests<int> r;
  r.push(1);
  r.add_save_point();
  r.push(2);
  r.add_save_point();
  r.push(3);
  EXPECT_EQ(taken(r), Ints{1});
  EXPECT_EQ(taken(r), Ints{});
  r.remove_save_point();
  EXPECT_EQ(taken(r), Ints{2});
  const Ints back{4, 5};
  r.put_back(back.begin(), back.end());
  EXPECT_EQ(taken(r), back);
  r.remove_save_point();
  EXPECT_EQ(taken(r), Ints{3});
}

TEST(Requests, AreReplacedOnlyBehindASave) {
  api::Requests<int> r;
  const auto any = [](int) { return true; };
  r.push(1);
  ASSERT_NE(r.newest(any), nullptr);
  EXPECT_EQ(*r.newest(any), 1);
  r.add_save_point();
  EXPECT_EQ(r.newest(any), nullptr);
  r.push(2);
  r.discard_if(any);
  EXPECT_EQ(r.all(), Ints{1});
}

/// Those before a save that comes before a load are for the file, those between are void, those after are for what is loaded.
TEST(Requests, OfASimulationThatIsReplacedAreVoidUnlessASaveComesFirst) {
  api::Requests<int> r;
  r.push(1);
  r.add_save_point();
  r.push(2);
  r.hold_back();
  r.push(3);
  EXPECT_EQ(taken(r), Ints{1});
  r.remove_save_point();
  EXPECT_EQ(taken(r), Ints{});
  r.go_on();
  EXPECT_EQ(taken(r), Ints{3});
  r.push(4);
  r.hold_back();
  r.push(5);
  r.add_save_point();  // of the simulation to come
  EXPECT_EQ(taken(r), Ints{});
  r.go_on();
  EXPECT_EQ(taken(r), Ints{5});
  r.remove_save_point();
  r.hold_back();
  const Ints void_now{6};
  r.put_back(void_now.begin(), void_now.end());  // they were taken for the simulation that ends
  r.go_on();
  EXPECT_EQ(taken(r), Ints{});
}

ToolSpec ball() {
  ToolSpec tool;
  tool.name = "ball";
  tool.path = {{0, 0.05, 0.3, 0.03, 0, 0, 0, 1}};
  return tool;
}

/// A file has what was asked for before save(), and nothing of what was asked for after it.
TEST(SaveOfALiveWorld, HasWhatWasAskedForBefore) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  SceneSpec scene = block();
  scene.tools = {ball()};
  ChangeSpec before, after;
  before.gravity = Vec3d{0, -2, 0};
  after.gravity = Vec3d{0, -1, 0};
  World live(scene, on("cpu", true)), loaded(scene, on("cpu", true)), stepped(scene, on("cpu", true));
  Told told(live);
  live.run_live({5, 1});  // a frame takes long enough for all calls to come before the next
  until_frames(live, 2);
  live.change(before);
  live.drive_tool("ball", {0.05, 0.29, 0.03}, {0, 0, 0, 1}, 0.01);
  live.save(file);
  live.change(after);
  live.drive_tool("ball", {0.05, 0.2, 0.03}, {0, 0, 0, 1}, 0.01);
  live.cut({{{{-1, 0.045, -1}, {-1, 0.045, 3}, {3, 0.045, -1}}}});
  const Event saved = told.wait_for("saved");
  EXPECT_NE(saved.text.find(file), std::string::npos);
  told.wait_for("cut");
  live.stop_live();
  EXPECT_EQ(live.pieces(0), 2);
  loaded.load(file);
  EXPECT_EQ(loaded.pieces(0), 1);
  EXPECT_EQ(loaded.step_number(), saved.step);
  stepped.step(saved.step);
  stepped.change(before);
  stepped.drive_tool("ball", {0.05, 0.29, 0.03}, {0, 0, 0, 1}, 0.01);
  for (World* world : {&loaded, &stepped}) world->step(200);
  EXPECT_EQ(loaded.hash(), stepped.hash());
  EXPECT_EQ(loaded.tool_forces()[0].position, stepped.tool_forces()[0].position);
}

TEST(RemovedTools, AreNotAmongThoseThatAMessageLists) {
  SceneSpec scene = block();
  scene.tools = {ball()};
  World world(scene, on("cpu"));
  world.run_live();
  ToolSpec other = ball();
  other.name = "other";
  world.add_tool(other);
  EXPECT_NE(message_of([&] { world.park_tool("x"); }).find("\"ball\", \"other\""), std::string::npos);
  world.remove_tool("other");
  const std::string text = message_of([&] { world.park_tool("other"); });
  EXPECT_NE(text.find("there are \"ball\""), std::string::npos) << text;
}

}  // namespace
}  // namespace pliant
