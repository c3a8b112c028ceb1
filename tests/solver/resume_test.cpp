// A resumed run gives the bits of an uninterrupted one, and a checkpoint resumes only what it was taken from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/save.h"
#include "pliant/error.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant::resume_test {
namespace {

using testing::pressed_cube;

class Resume : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
  Simulation make(const Scene& scene) { return {scene, open_backend(GetParam())}; }

  /// Run `first` steps, save, load into a new simulation, run `second` steps; compare with all of them in one go.
  void expect_same_bits(const Scene& scene, std::int64_t first, std::int64_t second) {
    Simulation whole = make(scene);
    ASSERT_EQ(whole.advance(first + second), first + second);
    const auto file = folder_.path() / "state.pckpt";
    {
      Simulation part = make(scene);
      ASSERT_EQ(part.advance(first), first);
      write_checkpoint(file, take_checkpoint(part));
    }
    Simulation resumed = make(scene);
    restore_checkpoint(resumed, read_checkpoint(file), file);
    EXPECT_EQ(resumed.step(), first);
    ASSERT_EQ(resumed.advance(second), second);
    EXPECT_EQ(resumed.hash(), whole.hash());
    EXPECT_EQ(resumed.step(), whole.step());
    EXPECT_EQ(resumed.time(), whole.time());
    EXPECT_EQ(resumed.dt(), whole.dt());
    EXPECT_EQ(resumed.stable_dt(), whole.stable_dt());
    EXPECT_EQ(write_state(resumed.state()), write_state(whole.state()));
    EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
    EXPECT_EQ(resumed.residual(), whole.residual());
  }

  test::TempFolder folder_;
};

TEST_P(Resume, FixedStep) { expect_same_bits(pressed_cube(0.01, R"("dt": 0.002,)"), 37, 63); }

TEST_P(Resume, Relaxation) {
  expect_same_bits(pressed_cube(0.01, R"("relaxation": {"tolerance": 1e-6, "max_steps": 1000},)"), 37, 63);
}

TEST_P(Resume, RelaxationOfAHybrid) {
  Scene scene = pressed_cube(0.01, R"("relaxation": {"tolerance": 1e-6, "max_steps": 1000},)");
  scene.bodies[0].model.type = ModelType::hybrid;
  scene.bodies[0].model.ratio = 0.5;
  scene.bodies[0].model.young = 3000;
  scene.bodies[0].model.substeps = 3;
  expect_same_bits(scene, 37, 163);
  expect_same_bits(scene, 132, 68);
}

TEST_P(Resume, AutomaticStepAcrossItsRenewal) {
  const Scene scene = pressed_cube(-0.01, "", 30000, "neo-hookean", 1);
  Simulation probe = make(scene);
  const double first = probe.dt();
  probe.advance(520);
  ASSERT_LT(probe.dt(), first) << "the scene must be stretched far enough for the step to change at step 512";
  for (const std::int64_t at : {500, 512, 513}) expect_same_bits(scene, at, 520 - at);
}

TEST_P(Resume, AutomaticStepThatWasTriedAgain) {
  Scene scene = pressed_cube(0.04);  // pressed flat within a few dozen steps
  scene.inverted = Inverted::stop;
  Simulation probe = make(scene);
  probe.advance(200);
  ASSERT_LT(probe.state().limit.dt_backoff, 1) << "the scene must be fast enough to overtake its step";
  ASSERT_FALSE(probe.divergence());
  for (const std::int64_t at : {17, 64, 100, 199}) expect_same_bits(scene, at, 200 - at);
}

TEST_P(Resume, AutomaticStepThatElementsOutgrew) {
  const Scene scene = pressed_cube(0.12);  // beyond its other side
  Simulation probe = make(scene);
  probe.advance(400);
  ASSERT_FALSE(probe.divergence());
  ASSERT_GT(probe.report().inversions.batches, 0);
  ASSERT_GT(probe.state().limit.hold, 0) << "the scene must be fast enough to overtake its step";
  for (const std::int64_t at : {17, 64, 100, 199, 333}) expect_same_bits(scene, at, 400 - at);
}

TEST_P(Resume, AStateWithInertiaIsOneOfAnotherModel) {
  const Scene scene = pressed_cube(0.01);
  Simulation whole = make(scene);
  whole.advance(64);
  Snapshot heavier = whole.snapshot();
  heavier.state.ballast = {{whole.model().bodies[0].slot[100], 0.01}, {whole.model().bodies[0].slot[101], 0.02}};
  std::sort(heavier.state.ballast.begin(), heavier.state.ballast.end(),
            [](const NodeInertia& a, const NodeInertia& b) { return a.slot < b.slot; });
  Simulation light = make(scene);
  light.advance(64);
  EXPECT_NE(test::error_of([&] { light.restore(heavier); }).find("not the same: bodies"), std::string::npos);
}

TEST_P(Resume, EveryIntegrator) {
  for (const Integrator integrator : all_integrators()) {
    Scene scene = pressed_cube(0.01, R"("dt": 0.0005,)");
    scene.integrator = integrator;
    expect_same_bits(scene, 64, 36);
  }
}

std::string label(const ::testing::TestParamInfo<const char*>& backend) {
  const std::string name = backend.param;
  return name == "cpu" ? "cpu" : name == "cpu:double" ? "cpu_double" : "opencl";
}
INSTANTIATE_TEST_SUITE_P(On, Resume, ::testing::Values("cpu", "cpu:double", "opencl:0"), label);

std::string refusal(Simulation& simulation, const Checkpoint& checkpoint) {
  const std::uint64_t before = simulation.hash();
  const std::string message = test::error_of([&] { restore_checkpoint(simulation, checkpoint, "state.pckpt"); });
  EXPECT_EQ(simulation.hash(), before) << "a refused checkpoint must change nothing";
  return message;
}

TEST(ResumeRefuses, WhatItDoesNotBelongTo) {
  const Scene scene = pressed_cube(0.01, R"("dt": 0.002,)");
  Simulation source(scene, open_backend("cpu"));
  source.advance(10);
  const Checkpoint checkpoint = take_checkpoint(source);

  struct Other {
    const char* part;
    Scene scene;
  };
  const auto with = [](const std::string& extra) { return pressed_cube(0.01, R"("dt": 0.002, )" + extra + ","); };
  const Other others[]{
      {"dt", pressed_cube(0.01, R"("dt": 0.001,)")},
      {"bodies", pressed_cube(0.02, R"("dt": 0.002,)")},
      {"bodies", pressed_cube(0.01, R"("dt": 0.002,)", 4000)},
      {"bodies", pressed_cube(0.01, R"("dt": 0.002,)", 3000, "saint-venant-kirchhoff")},
      {"integrator", with(R"("integrator": "textbook")")},
      {"relaxation", with(R"("relaxation": {})")},
      {"safety", with(R"("safety": 0.8)")},
      {"inverted", with(R"("inverted": "stop")")},
      {"least_step", with(R"("least_step": 0)")},
      {"break_stretch", with(R"("break_stretch": 0)")},
      {"curves", pressed_cube(0.01, R"("dt": 0.002,)", 3000, "neo-hookean", 0.3)},
      {"focus", with(R"("focus": {"path": [[0, 0, 0.1, 0]]})")},
  };
  for (const Other& other : others) {
    Simulation simulation(other.scene, open_backend("cpu"));
    const std::string message = refusal(simulation, checkpoint);
    EXPECT_NE(message.find("state.pckpt: a checkpoint of \"pressed_cube\""), std::string::npos);
    EXPECT_NE(message.find(std::string("not the same: ") + other.part), std::string::npos) << message;
  }
  for (const auto change :
       {+[](Scene& s) { s.gravity[0] = 1; }, +[](Scene& s) { s.gravity_curve = s.bodies[0].prescribed[0].curve; }}) {
    Scene other = scene;
    change(other);
    Simulation simulation(other, open_backend("cpu"));
    EXPECT_NE(refusal(simulation, checkpoint).find("gravity"), std::string::npos);
  }
  Simulation oracle(scene, open_backend("cpu:double"));
  EXPECT_NE(refusal(oracle, checkpoint).find("in float"), std::string::npos);

  Simulation same(scene, open_backend("cpu"));
  Checkpoint damaged = checkpoint;
  damaged.snapshot.buffers[0].bytes.pop_back();
  EXPECT_NE(refusal(same, damaged).find("node_u"), std::string::npos);
  damaged = checkpoint;
  damaged.snapshot.state.clock.dt = -1;
  EXPECT_NE(refusal(same, damaged).find("run state"), std::string::npos);
  restore_checkpoint(same, checkpoint, "state.pckpt");
  EXPECT_EQ(same.hash(), source.hash());
}

TEST(ResumeRefuses, NothingAfterADivergenceButTheLastGoodState) {
  Scene scene = pressed_cube(0.01);
  Simulation stable(scene, open_backend("cpu"));
  scene.dt = 3 * stable.stable_dt();
  Simulation unstable(scene, open_backend("cpu"));
  unstable.advance(5000);
  ASSERT_TRUE(unstable.divergence().has_value());
  EXPECT_EQ(unstable.step(), unstable.divergence()->last_good_step);
  // The state kept must itself pass: its elements are whole, so one more step starts from finite numbers.
  for (const Vec3d& u : unstable.displacements(0)) {
    for (const double c : u) EXPECT_TRUE(std::isfinite(c));
  }
  Simulation again(scene, open_backend("cpu"));
  restore_checkpoint(again, take_checkpoint(unstable), "state.pckpt");
  EXPECT_EQ(again.hash(), unstable.hash());
}

}  // namespace
}  // namespace pliant::resume_test
