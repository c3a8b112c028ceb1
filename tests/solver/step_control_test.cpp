// Changes of the step and of the damping of dynamic relaxation while a run goes on.
#include "simulation/step/step_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "cutting/cut_scenes.h"
#include "pliant/error.h"
#include "simulation/recovery/recovery.h"
#include "simulation/step/coupling.h"
#include "solver/loaded.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

using namespace cut_test;

std::string refusal(const Body& body) {
  try {
    const Simulation s(scene_with(body), open_backend("cpu"));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FirstStep, SaysWhyThereIsNone) {
  Body held = box_body("box", {0.03, 0.02, 0.02}), stiff = held;
  hold(held, {-1, 0, 0}, {1, 0, 0});
  EXPECT_NE(refusal(held).find("hold every node of every body"), std::string::npos) << refusal(held);
  stiff.material.set_moduli(Law::neo_hookean, Moduli::from_lame(1e40, 1e40));
  EXPECT_NE(refusal(stiff).find("give no finite forces on cpu"), std::string::npos) << refusal(stiff);
}

/// Far from its rest position, differences of forces in float are rounding, and the bound of the elements keeps the step.
TEST(StepFarAway, IsThatOfTheElementBound) {
  Body body = box_body("box", {0.03, 0.02, 0.02});
  body.velocity = {3000, -2000, 1000};
  Simulation s(scene_with(body), open_backend("cpu"));
  const double first = s.dt();
  s.advance(600);
  EXPECT_GT(s.dt(), 0.5 * first);
}

/// A body that flies through empty space, with half of its automatic step.
class HalvedStep : public ::testing::Test {
 protected:
  HalvedStep() : full(s.dt()) {
    Snapshot halved = s.snapshot();
    halved.state.clock.dt = 0.5 * full;  // the increments stay: twice the velocity
    s.restore(halved);
  }
  static Scene flying() {
    Body body = box_body("box", {0.03, 0.02, 0.02});
    body.velocity = {0.1, -0.05, 0.15};
    return scene_with(body);
  }
  Simulation s{flying(), open_backend("cpu:double")};
  double full;
};

TEST_F(HalvedStep, GrowsAgainAndTheVelocityStays) {
  EXPECT_EQ(s.dt(), 0.5 * full);
  const Vec3d velocity{0.2, -0.1, 0.3};
  const auto expect_velocity = [&] {
    for (const Vec3d& v : s.velocities(0)) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(v[c], velocity[c], 1e-10);
    }
  };
  expect_velocity();
  const double x = s.displacements(0)[0][0];
  s.advance(300);
  EXPECT_GT(s.dt(), 0.9 * full) << "nothing keeps the step small";
  expect_velocity();
  EXPECT_NEAR(s.displacements(0)[0][0] - x, velocity[0] * s.time(), 1e-10);
}

/// Loads come on after the start: the step is looked at after 64 and 128 steps, then every 256.
TEST_F(HalvedStep, IsLookedAtAfter64Steps) {
  s.advance(64);
  EXPECT_EQ(s.dt(), 0.5 * full);
  s.advance(1);
  EXPECT_GT(s.dt(), 0.9 * full);
}

/// Every 32 steps the damping becomes twice the root of the Rayleigh quotient of what has moved since the last change.
TEST(Relaxation, DampsWhatHasMovedSinceTheLastChange) {
  const Scene scene = testing::pressed_cube(0.01, R"("relaxation": {"tolerance": 1e-9, "max_steps": 1000},)");
  Simulation s(scene, open_backend("cpu:double"));
  const Model& model = s.model();
  std::vector<bool> free(3 * model.mass.size(), true);
  for (const Constraint& c : model.constraints) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((c.axes >> axis & 1) != 0) free[3 * static_cast<std::size_t>(c.slot) + axis] = false;
    }
  }
  const double material = *std::max_element(model.damping.begin(), model.damping.end());
  s.advance(32);
  for (int change = 0; change < 4; ++change) {
    const RelaxationState before = s.state().relaxation;
    s.advance(32);
    const RelaxationState& now = s.state().relaxation;
    EXPECT_EQ(now.u, s.backend().read_reals(s.program().find("node_u")));
    double stiffness = 0, inertia = 0;
    for (std::size_t slot = 0; slot < model.mass.size(); ++slot) {
      for (std::size_t c = 0; c < 3 && model.mass[slot] > 0; ++c) {
        if (!free[3 * slot + c]) continue;
        const double du = now.u[4 * slot + c] - before.u[4 * slot + c];
        stiffness -= du * (now.force[4 * slot + c] - before.force[4 * slot + c]);
        inertia += model.mass[slot] * du * du;
      }
    }
    ASSERT_GT(stiffness, 0);
    EXPECT_NEAR(now.damping, std::max(0.0, 2 * std::sqrt(stiffness / inertia) - material), 1e-9 * now.damping) << change;
  }
}

/// A beam that bends by many of its cells: rounding of its displacements shakes its highest modes, whose forces are a hundred
/// times what the tolerance allows. It comes to rest all the same, and where it does in double at a tenth of the tolerance.
TEST(Relaxation, EndsInFloatWhereItEndsInDouble) {
  Body body = box_body("beam", {0.2, 0.01, 0.01});
  body.lattice.spacing = 0.005;
  body.material.set_moduli(Law::neo_hookean, Moduli::from_lame(0, 941760));
  Fixed held;
  held.where.kind = Selection::Kind::plane;
  held.where.a = {1e-6, 0, 0};
  held.where.b = {-1, 0, 0};
  body.fixed.push_back(held);
  Scene scene = scene_with(body);
  scene.gravity = {0, -9.81, 0};
  scene.relaxation.enabled = true;
  scene.relaxation.max_steps = 40000;
  const auto rest = [&](const char* backend, double tolerance) {
    scene.relaxation.tolerance = tolerance;
    auto s = std::make_unique<Simulation>(scene, open_backend(backend));
    s->advance(scene.relaxation.max_steps);
    EXPECT_TRUE(s->at_equilibrium()) << backend << ", residual " << s->residual();
    return s;
  };
  const auto exact = rest("cpu:double", 1e-7), rounded = rest("cpu", 1e-6);
  const std::vector<Vec3d> a = exact->displacements(0), b = rounded->displacements(0);
  double most = 0, largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    most = std::max(most, vec::norm(vec::sub(a[n], b[n])));
    largest = std::max(largest, vec::norm(a[n]));
  }
  std::printf("  double %lld steps, float %lld, difference %.2e\n", static_cast<long long>(exact->step()),
              static_cast<long long>(rounded->step()), most / largest);
  EXPECT_LE(most / largest, 1e-4);
  EXPECT_LE(rounded->step(), 2 * exact->step());
}

/// However little a burst state stands: above the floor no further than to it, and below by a third at least.
TEST(StepRetries, StopAtTheFloorBeforeTheyGoBelow) {
  Loaded l(scene_with(box_body("box", {0.03, 0.02, 0.02})));
  StepControl step(l.run);
  HostLoads loads(l.run);
  RunReports reports;
  TopologyEdits edits(l.run, step, loads, reports.now);
  Recovery recovery(l.run, step, edits, reports);
  Symptoms lost;
  lost.lost_in = 1;
  step.start(0, true);
  const double first = l.state.clock.dt, floor = l.scene.least_step * first;
  l.state.clock.dt = 1.2 * floor;
  l.state.limit.dt_backoff = 0.04;  // of what it stands at rest: far below
  ASSERT_TRUE(recovery.trust_less(lost));
  EXPECT_DOUBLE_EQ(l.state.clock.dt, floor);
  l.state.limit.dt_backoff = 0.03;
  ASSERT_TRUE(recovery.trust_less(lost));
  EXPECT_DOUBLE_EQ(l.state.clock.dt, 0.35 * floor);
  EXPECT_FALSE(recovery.trust_less(lost)) << "there is an end to it";
}

/// A box that is squeezed between two looks, while its nodes shake: a batch of a step that is stable still stays.
TEST(StepRetries, WhatOnlyTheSafetyForbidsIsNotMadeAgain) {
  for (const double share : {0.96, 1.04}) {  // of the stable step
    Loaded l(scene_with(box_body("box", {0.03, 0.02, 0.02})));
    StepControl step(l.run);
    HostLoads loads(l.run);
    RunReports reports;
    TopologyEdits edits(l.run, step, loads, reports.now);
    Recovery recovery(l.run, step, edits, reports);
    step.start(0, true);
    l.settings.batch_steps = 64;
    recovery.keep(true);
    const Model& model = l.loaded.model();
    const double first = l.state.clock.dt;
    const auto squeeze = [&](double by) {
      std::vector<double> u(4 * static_cast<std::size_t>(model.slots));
      for (std::size_t s = 0; s < model.rest.size(); ++s) u[4 * s] = -by * model.rest[s][0];
      l.run.write_u(u);
      return step.estimate(20);
    };
    double low = 0, high = 0.7;
    for (int i = 0; i < 30; ++i) (first < share * squeeze(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    std::vector<double> w = l.loaded.w();
    for (std::size_t s = 0; s < model.rest.size(); ++s) w[4 * s + 1] = (s % 2 == 0 ? 0.12 : -0.12) * model.shortest;
    l.loaded.write_w(w);
    l.state.clock.step = 64;
    EXPECT_FALSE(recovery.look(0));
    recovery.shorten();
    EXPECT_EQ(reports.now.made_again, share < 1 ? 0 : 1);
    EXPECT_EQ(l.state.clock.step, share < 1 ? 64 : 0);
    EXPECT_LE(l.state.clock.dt, 0.9 * first);
    EXPECT_GT(l.state.clock.dt, 0.5 * first);
  }
}

/// An estimate tries states that the run is never in: what their elements mark is nothing that happened.
TEST(StepRetries, NoEstimateMarksElements) {
  Scene scene = scene_with(box_body("box", {0.03, 0.02, 0.02}));
  scene.bodies[0].material.set_moduli(Law::saint_venant_kirchhoff, Moduli::from_young(3000, 0.3));
  scene.inverted = Inverted::stop;
  Simulation estimates(scene, open_backend("cpu")), resumed(scene, open_backend("cpu"));
  estimates.advance(1);
  const BufferId id = estimates.program().find("node_u");
  std::vector<double> u = estimates.backend().read_reals(id);
  const Model& model = estimates.model();
  for (std::size_t s = 0; s < model.rest.size(); ++s) u[4 * s + 1] = (1e-4 - 1) * model.rest[s][1];  // all but flat
  estimates.backend().write_reals(id, u);
  estimates.estimate_stable_dt();
  resumed.restore(estimates.snapshot());
  estimates.advance(1);
  resumed.advance(1);
  EXPECT_EQ(estimates.divergence().has_value(), resumed.divergence().has_value());
  EXPECT_EQ(estimates.deep_hash(), resumed.deep_hash());
  EXPECT_EQ(estimates.state().limit.dt_backoff, 1);
}

/// What asks for less is lost, and is calmed instead.
TEST(StepRetries, NoEstimateTakesTheStepBelowAThousandth) {
  Loaded l(scene_with(box_body("box", {0.03, 0.02, 0.02})));
  StepControl step(l.run);
  step.start(0, true);
  const double first = l.state.clock.dt;
  const Model& model = l.loaded.model();
  std::vector<double> u(4 * static_cast<std::size_t>(model.slots));
  for (std::size_t s = 0; s < model.rest.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) u[4 * s + c] = 1000 * model.rest[s][c];
  }
  l.run.write_u(u);
  step.adapt();
  EXPECT_LT(l.state.limit.stable_dt, 1e-4 * first);
  EXPECT_DOUBLE_EQ(l.state.clock.dt, 1e-3 * first);
  l.state.clock.dt = 2e-4 * first;  // after retries of a batch that was lost
  step.adapt();
  EXPECT_DOUBLE_EQ(l.state.clock.dt, 2e-4 * first);
}

}  // namespace
}  // namespace pliant
