// The backend of a World on a machine without a GPU, which lets the twins compute until kernels are compiled: nobody sees when
// they change.
#include <array>
#include <chrono>
#include <filesystem>
#include <thread>

#include "api/scenes.h"
#include "backends/choice/kernel_warmer.h"
#include "backends/choice/tiered_backend.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/twins/ref_backend.h"
#include "scene/spec.h"
#include "support/opencl.h"
#include "support/temp_folder.h"

namespace pliant::tiered_test {
namespace {

using namespace test;

constexpr int kNoDevice = 4711;

/// How often each of the two has run passes.
using Runs = std::array<std::atomic<int>, 2>;

class CountingBackend final : public ForwardingBackend {
 public:
  CountingBackend(std::unique_ptr<Backend> inner, std::shared_ptr<Runs> runs, int which)
      : ForwardingBackend(std::move(inner)), runs_(std::move(runs)), which_(which) {}
  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    ++(*runs_)[which_];
    ForwardingBackend::run(passes, first, count, origin);
  }

 private:
  std::shared_ptr<Runs> runs_;
  std::size_t which_;
};

/// A block that can be cut, pressed by a ball, a part of it by shape matching.
SceneSpec pressed_block() {
  SceneSpec scene = block();
  scene.bodies[0].name = "block";
  scene.bodies[0].material.poisson = 0.4;
  scene.dt = 5e-4;
  ToolSpec ball;
  ball.name = "ball";
  ball.radius = 0.015;
  ball.path = {{0, 0.05, 0.11, 0.03, 0, 0, 0, 1}, {0.04, 0.05, 0.07, 0.03, 0, 0, 0, 1}};
  scene.tools.push_back(ball);
  return scene;
}

class Tiered : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
    forget_warm();
  }

  World open(int device = 0) {
    const OpenBackend tiered = [device, runs = runs_](std::string*, std::int64_t) {
      return make_tiered_backend(std::make_unique<CountingBackend>(make_ref_backend(RefOptions{}), runs, 0),
                                 std::make_unique<CountingBackend>(make_opencl_backend(0), runs, 1), device);
    };
    return WorldAccess::make(scene_of(pressed_block()), tiered, options());
  }
  static World reference() {
    const OpenBackend twins = [](std::string*, std::int64_t) { return make_ref_backend(RefOptions{}); };
    return WorldAccess::make(scene_of(pressed_block()), twins, options());
  }
  static WorldOptions options() {
    WorldOptions options;
    options.cutting = true;
    options.interactive = true;
    return options;
  }

  /// Steps both until OpenCL computes, and a while on.
  void step_until_opencl(World& world, World& reference) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    (*runs_)[1] = 0;
    for (int left = 20; left > 0 && std::chrono::steady_clock::now() < end;) {
      world.step(5);
      reference.step(5);
      ASSERT_EQ(world.hash(), reference.hash()) << "at step " << world.step_number();
      if ((*runs_)[1] > 0) --left;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_GT((*runs_)[1], 0) << "OpenCL does not compute";
  }

  std::shared_ptr<Runs> runs_ = std::make_shared<Runs>();
};

TEST_F(Tiered, TheTwinsBeginAndOpenclGoesOnWithTheSameBits) {
  World world = open(), other = reference();
  EXPECT_EQ(world.info().backend, "opencl:0");
  EXPECT_EQ(world.frame()->positions.size(), other.frame()->positions.size());
  EXPECT_GT((*runs_)[0], 0);
  EXPECT_EQ((*runs_)[1], 0) << "a kernel was launched, and compiled, before the first step";
  step_until_opencl(world, other);
  EXPECT_GT(world.tool_forces().front().force[1], 0.0) << "the ball does not touch";
  EXPECT_EQ(positions(world), positions(other));
  EXPECT_TRUE(world.remarks() == other.remarks());
  const std::vector<Event> told = world.events();
  ASSERT_EQ(told.size(), other.events().size() + 1);
  const auto changed = std::find_if(told.begin(), told.end(), [](const Event& e) { return e.kind == "backend"; });
  ASSERT_NE(changed, told.end());
  EXPECT_EQ(changed->subject, "opencl:0");
  EXPECT_GT(changed->step, 0);
}

TEST_F(Tiered, EditsMeetTheSameBitsBeforeAndAfter) {
  const TempFolder folder;
  World world = open(), other = reference();
  for (World* w : {&world, &other}) {
    w->step(7);
    w->cut({{{{0.047, -1, -1}, {0.047, 1, -1}, {0.047, 1, 1}}}, {{{0.047, -1, -1}, {0.047, 1, 1}, {0.047, -1, 1}}}});
    w->step(9);
    ToolSpec second = pressed_block().tools[0];
    second.name = "second";
    second.path = {{0, 0.02, 0.12, 0.03, 0, 0, 0, 1}};
    w->add_tool(second);
    w->step(3);
    w->parse_change(R"({"body": "block", "material": {"young": 4000}})");
    w->save((folder.path() / "state.pck").string());
  }
  EXPECT_EQ(world.hash(), other.hash());
  step_until_opencl(world, other);
  for (World* w : {&world, &other}) {
    w->remove_tool("second");
    w->step(11);
    w->cut({{{{-1, 0.047, -1}, {1, 0.047, -1}, {1, 0.047, 1}}}, {{{-1, 0.047, -1}, {1, 0.047, 1}, {-1, 0.047, 1}}}});
    w->step(50);
  }
  EXPECT_EQ(world.hash(), other.hash());
  forget_warm();  // so that what follows goes back to the twins
  (*runs_)[0] = 0;
  for (World* w : {&world, &other}) {
    w->load((folder.path() / "state.pck").string());
    w->step(20);
  }
  EXPECT_EQ(world.hash(), other.hash());
  EXPECT_GT((*runs_)[0], 0);
  step_until_opencl(world, other);
  forget_warm();
  (*runs_)[0] = 0;
  for (World* w : {&world, &other}) {
    w->cut({{{{-1, -1, 0.027}, {1, -1, 0.027}, {1, 1, 0.027}}}, {{{-1, -1, 0.027}, {1, 1, 0.027}, {-1, 1, 0.027}}}});
    w->step(20);
  }
  EXPECT_GT((*runs_)[0], 0);
  EXPECT_EQ(world.hash(), other.hash());
  step_until_opencl(world, other);
  for (World* w : {&world, &other}) {
    w->reset();
    w->step(64);
  }
  EXPECT_EQ(world.hash(), other.hash());
}

TEST_F(Tiered, ADeviceThatFailsIsReportedAndTheTwinsGoOn) {
  World world = open(kNoDevice), other = reference();
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  std::vector<std::string> remarks;
  do {
    world.step(5);
    other.step(5);
    remarks = world.remarks();
  } while (remarks == other.remarks() && std::chrono::steady_clock::now() < end);
  ASSERT_GT(remarks.size(), other.remarks().size());
  EXPECT_NE(remarks.back().find("cpu computes in place of opencl:0: there is no OpenCL device 4711"), std::string::npos)
      << remarks.back();
  EXPECT_EQ(world.hash(), other.hash());
  EXPECT_EQ((*runs_)[1], 0);
}

TEST_F(Tiered, IsWhatAWorldGets) {
  World world(pressed_block(), on("auto"));
  if (world.info().reason.find("a bit-exact GPU") == 0) GTEST_SKIP() << "this machine has a GPU";
  EXPECT_NE(world.info().reason.find("cpu computes until its kernels are compiled"), std::string::npos) << world.info().reason;
}

}  // namespace
}  // namespace pliant::tiered_test
