// A World that runs freely: frames come by themselves, calls go on, errors and events are told.
#include "live.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <thread>

#include "c_world.h"
#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using namespace live_test;
using test::block;
using test::code_of;
using test::message_of;
using test::on;

constexpr std::int32_t kLiveCorner = 7;  ///< at (0.1, 0.08, 0.06)

ToolSpec ball(const Vec3d& at) {
  ToolSpec tool;
  tool.name = "ball";
  tool.path = {{0, at[0], at[1], at[2], 0, 0, 0, 1}};
  return tool;
}

TEST(Live, StepsByItselfUntilItIsStopped) {
  World world(block(), on("cpu"));
  EXPECT_FALSE(world.live_state().running);
  world.run_live();
  EXPECT_TRUE(world.busy());
  const FramePtr first = world.frame();
  until([&] { return world.poll() && world.frame()->step > first->step; });
  EXPECT_TRUE(world.live_state().running);
  for (const auto& call : std::vector<std::function<void()>>{[&] { world.step(1); }, [&] { world.advance(0.1); },
                                                             [&] { world.step_async(1); }, [&] { world.advance_async(0.1); }}) {
    EXPECT_EQ(code_of(call), ErrorCode::state);
  }
  EXPECT_NE(message_of([&] { world.step(1); }).find("stop_live()"), std::string::npos);
  const StepReport report = world.stop_live();
  EXPECT_FALSE(world.busy());
  EXPECT_EQ(report.step, world.step_number());
  EXPECT_EQ(world.frame()->step, report.step);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(world.step_number(), report.step);
  EXPECT_EQ(world.step(3).done, 3);
}

/// What it computes is what step() computes.
TEST(Live, HasTheBitsOfAnyOtherRun) {
  World live(block(), on("cpu")), stepped(block(), on("cpu"));
  live.run_live({200, 1});
  until_frames(live, 10);
  static_cast<void>(live.vertex_values("mises"));  // a call that waits, in the middle
  until_frames(live, 10);
  const StepReport report = live.stop_live();
  ASSERT_GT(report.step, 0);
  stepped.step(report.step);
  EXPECT_EQ(live.hash(), stepped.hash());
}

TEST(Live, CallsThatWaitDoSoForAFrameAndItGoesOn) {
  World world(block(), on("cpu"));
  world.run_live();
  for (int i = 0; i < 20; ++i) {
    const std::uint64_t a = world.hash(), b = world.hash();  // frames may lie between two calls, but each sees one state
    EXPECT_NE(a, 0u);
    EXPECT_NE(b, 0u);
    EXPECT_EQ(world.displacements(0).size(), static_cast<std::size_t>(world.info().nodes));
  }
  until_frames(world, 3);
  world.wait();
  until_frames(world, 3);
  EXPECT_THROW(world.run_live({0, 1}), Error);
  world.run_live({100, 0.5});  // other options
  until_frames(world, 3);
}

TEST(Live, CutsAndToolsAreTakenUpAndToldAsEvents) {
  SceneSpec scene = block(0);
  scene.gravity = {};  // the upper piece stays where it is
  World world(scene, on("cpu", true));
  Told told(world);
  world.run_live();
  EXPECT_TRUE(world.cut({{{{-1, 0.045, -1}, {-1, 0.045, 3}, {3, 0.045, -1}}}}).pending);
  const Event cut = told.wait_for("cut");
  EXPECT_GT(cut.amount, 10);
  EXPECT_NE(cut.text.find("the step fell from"), std::string::npos) << cut.text;  // there was no blade before
  ASSERT_TRUE(cut.placed);
  EXPECT_NEAR(cut.position[1], 0.045, 0.02);
  const Event pieces = told.wait_for("pieces");
  EXPECT_EQ(pieces.subject, "block");
  EXPECT_EQ(pieces.amount, 2);
  world.add_tool(ball({0.05, 0.2, 0.03}));
  until([&] { return world.tool_forces().size() == 1; });
  world.place_tool("ball", {0.05, 0.02, 0.03});  // deep inside: the worker refuses it and goes on
  EXPECT_NE(told.wait_for("refused").text.find("ball"), std::string::npos);
  until_frames(world, 3);
  EXPECT_TRUE(world.live_state().running);
}

TEST(Live, SaveLoadAndResetDoNotWait) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  World world(block(), on("cpu"));
  Told told(world);
  world.run_live();
  until_frames(world, 5);
  world.save(file);
  const Event saved = told.wait_for("saved");
  EXPECT_EQ(saved.subject, file);
  until_frames(world, 5);
  EXPECT_GT(world.step_number(), saved.step);
  world.load(file);
  EXPECT_EQ(told.wait_for("loaded").step, saved.step);
  ChangeSpec weightless;
  weightless.gravity = Vec3d{};
  world.reset();
  world.change(weightless);  // of the World after the reset
  EXPECT_EQ(told.wait_for("reset").step, 0);
  until_frames(world, 5);
  EXPECT_EQ(code_of([&] { world.load((folder.path() / "none.pck").string()); }), ErrorCode::io);
  const std::int64_t steps = world.stop_live().step;
  World other(block(), on("cpu"));
  other.change(weightless);
  other.step(steps);
  EXPECT_EQ(world.hash(), other.hash());
}

TEST(Live, AFileThatIsAboutToBeWrittenCanBeLoaded) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  World world(block(), on("cpu"));
  Told told(world);
  world.run_live({20, 1});
  until_frames(world, 3);
  for (int i = 0; i < 20; ++i) {  // at any moment of the worker
    world.save(file);
    world.load(file);
    EXPECT_EQ(told.wait_for("loaded").subject, file) << i;
    std::filesystem::remove(file);
  }
}

TEST(Live, ACallThatWaitsSeesWhatWasAskedForBefore) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  std::uint64_t start = 0;
  {
    World world(block(), on("cpu"));
    start = world.hash();
    world.run_live({20, 1});
    until_frames(world, 3);
    for (int i = 0; i < 5; ++i) {
      world.reset();
      EXPECT_EQ(world.hash(), start) << i;  // no frame lies between
    }
    world.save(file);
    world.wait();
    EXPECT_TRUE(std::filesystem::exists(file));
    std::filesystem::remove(file);
    world.save(file);
  }  // a World that ends writes what it was asked to save
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(Live, ARefusedLoadLeavesItAsItIs) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pck").string();
  World(block(0), on("cpu")).save(file);
  World world(block(), on("cpu"));
  Told told(world);
  world.run_live();
  until_frames(world, 3);
  const std::int64_t step = world.step_number();
  world.load(file);
  EXPECT_NE(told.wait_for("refused").text.find("cannot resume"), std::string::npos);
  until_frames(world, 3);
  EXPECT_GT(world.step_number(), step);
  world.add_tool(ball({0.05, 0.2, 0.03}));  // tools are taken up again
  until([&] { return world.tool_forces().size() == 1; });
  ChangeSpec softer;
  softer.gravity = Vec3d{0, -1, 0};
  world.change(softer);
  until_frames(world, 3);
  EXPECT_TRUE(world.events().empty());
}

TEST(Live, ARefusedToolIsNamed) {
  SceneSpec scene = block(0);
  scene.tools = {ball({0.05, 0.2, 0.03}), ball({0.02, 0.2, 0.03})};
  scene.tools[1].name = "second";
  World world(scene, on("cpu"));
  Told told(world);
  world.run_live();
  world.place_tool("second", {0.05, 0.04, 0.03});  // in the middle of the block
  const Event refused = told.wait_for("refused");
  EXPECT_EQ(refused.subject, "second");
  EXPECT_NE(refused.text.find("inside body 'block'"), std::string::npos) << refused.text;
}

TEST(Live, ADivergenceHoldsItUpUntilItRecovers) {
  World world(test::unstable(), on("cpu"));
  Told told(world);
  world.run_live();
  const Event diverged = told.wait_for("diverged");
  EXPECT_NE(diverged.text.find("step"), std::string::npos);
  EXPECT_TRUE(world.live_state().running);
  world.recover();
  static_cast<void>(told.wait_for("recovered"));
  static_cast<void>(told.wait_for("diverged"));  // it goes on, and its step is still too long
  world.reset();
  static_cast<void>(told.wait_for("reset"));
}

TEST(Recover, GoesOnFromTheLastGoodStateAtRest) {
  World world(test::unstable(), on("cpu"));
  while (!world.step(100).diverged) continue;
  const std::int64_t step = world.step_number();
  EXPECT_EQ(code_of([&] { world.step(1); }), ErrorCode::diverged);
  Simulation& simulation = WorldAccess::simulation(world);
  const auto w = [&] { return simulation.backend().read_reals(simulation.program().find("node_w")); };
  const std::vector<double> before = w();
  world.recover();
  const std::vector<double> after = w();
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i], i % 4 == 3 ? before[i] : 0) << i;  // the decay stays
  EXPECT_EQ(world.step_number(), step);
  for (const Vec3d& v : world.velocities(0)) EXPECT_EQ(v, (Vec3d{}));
  EXPECT_EQ(world.step(1).done, 1);
  World fine(block(), on("cpu"));
  fine.step(10);
  const std::uint64_t hash = fine.hash();
  fine.recover();  // nothing to recover from
  EXPECT_EQ(fine.hash(), hash);
}

TEST(ForceTrace, HasTheForceOfEveryStep) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.tools = {ball({0.05, 0.091, 0.03})};
  World world(scene, on("cpu"));
  world.drive_tool("ball", {0.05, 0.085, 0.03}, {0, 0, 0, 1}, 0.2);
  world.advance(0.3);
  const std::vector<ForceSample> trace = world.force_trace("ball");
  ASSERT_EQ(static_cast<std::int64_t>(trace.size()), std::min<std::int64_t>(4096, world.step_number()));
  for (std::size_t i = 0; i < trace.size(); ++i) {
    EXPECT_EQ(trace[i].step, world.step_number() - static_cast<std::int64_t>(trace.size() - i) + 1);
    EXPECT_GT(trace[i].time, i > 0 ? trace[i - 1].time : -1);
  }
  EXPECT_NEAR(trace.back().time, world.time(), 1e-12);
  // The force of tool_forces() is the mean of the last batch.
  const Vec3d mean = world.tool_forces().front().force;
  EXPECT_GT(mean[1], 0.01);
  const std::int64_t last = world.step_number();
  const StepReport more = world.step(16);
  ASSERT_EQ(more.done, 16);
  const std::vector<ForceSample> batch = world.force_trace("ball", last);
  ASSERT_EQ(batch.size(), 16u);
  Vec3d sum{};
  for (const ForceSample& s : batch) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += s.force[c] / 16;
  }
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], world.tool_forces().front().force[c], 1e-9 + 1e-6 * std::abs(sum[1]));
  EXPECT_EQ(code_of([&] { static_cast<void>(world.force_trace("bat")); }), ErrorCode::usage);
  world.reset();
  EXPECT_TRUE(world.force_trace("ball").empty());
}

TEST(ForceTrace, HasTheForceOfAGrabAtEachUpdate) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  World world(scene, on("cpu", true));
  const GrabId grab = world.grab(kLiveCorner);
  world.move_grab(grab, {0.11, 0.09, 0.06});
  world.advance(0.1);
  const std::vector<ForceSample> trace = world.force_trace(grab);
  ASSERT_GT(trace.size(), 20u);
  EXPECT_EQ(trace.back().force, world.grab_state(grab).force);
  EXPECT_EQ(world.force_trace(grab, trace[trace.size() - 3].step).size(), 2u);
  world.release(grab);
  EXPECT_EQ(code_of([&] { static_cast<void>(world.force_trace(grab)); }), ErrorCode::usage);
}

TEST(Events, TellALimitedGrabAndADeepTool) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  World world(scene, on("cpu", true));
  GrabOptions weak;
  weak.max_force = 0.01;
  const GrabId grab = world.grab(kLiveCorner, weak);
  world.move_grab(grab, {0.15, 0.12, 0.06});
  world.advance(0.2);
  const std::vector<Event> events = world.events();
  ASSERT_EQ(events.size(), 1u);  // once, not at every update
  EXPECT_EQ(events[0].kind, "limited");
  EXPECT_EQ(events[0].subject, std::to_string(grab));
  EXPECT_NEAR(events[0].amount, 0.01, 1e-4);
  ASSERT_TRUE(events[0].placed);
  EXPECT_NEAR(events[0].position[0], 0.1, 0.02);
  EXPECT_TRUE(world.events().empty());
}

TEST(Events, OfCCallersComeInOrderAndWait) {
  const test::CCube world;
  const double triangles[18] = {-1, 0.021, -1, -1, 0.021, 3, 3, 0.021, -1};
  ASSERT_EQ(pliant_world_cut(world, triangles, 1, nullptr), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(pliant_world_step(world, 10, nullptr), PLIANT_OK) << pliant_last_error();
  pliant_event event = PLIANT_EVENT_INIT;
  size_t given = 0;
  ASSERT_EQ(pliant_world_events(world, &event, 1, &given), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(given, 1u);
  EXPECT_STREQ(event.kind, "cut");
  ASSERT_EQ(pliant_world_events(world, &event, 1, &given), PLIANT_OK);
  ASSERT_EQ(given, 1u);
  EXPECT_STREQ(event.kind, "pieces");
  EXPECT_STREQ(event.subject, "a");
  ASSERT_EQ(pliant_world_events(world, &event, 1, &given), PLIANT_OK);
  EXPECT_EQ(given, 0u);
  pliant_live_options options = PLIANT_LIVE_OPTIONS_INIT;
  options.rate = 0;
  EXPECT_EQ(pliant_world_run_live(world, &options), PLIANT_USAGE);
  options = PLIANT_LIVE_OPTIONS_INIT;
  options.ahead = -1;
  EXPECT_EQ(pliant_world_run_live(world, &options), PLIANT_USAGE);
  options.ahead = 1;
  options.reserved = 1;
  EXPECT_EQ(pliant_world_run_live(world, &options), PLIANT_USAGE);
  ASSERT_EQ(pliant_world_run_live(world, nullptr), PLIANT_OK);
  pliant_live_state state = PLIANT_LIVE_STATE_INIT;
  ASSERT_EQ(pliant_world_live_state(world, &state), PLIANT_OK);
  EXPECT_EQ(state.running, 1);
  pliant_report report = PLIANT_REPORT_INIT;
  ASSERT_EQ(pliant_world_stop_live(world, &report), PLIANT_OK);
  EXPECT_GE(report.step, 10);
  pliant_force_sample sample = PLIANT_FORCE_SAMPLE_INIT;
  size_t needed = 0;
  EXPECT_EQ(pliant_world_force_trace(world, "none", -1, &sample, 1, &needed), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_grab_trace(world, 99, -1, &sample, 1, &needed), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_recover(world), PLIANT_OK);
}

}  // namespace
}  // namespace pliant
