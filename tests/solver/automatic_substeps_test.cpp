// Hybrids with "substeps": "auto": what is chosen, that it stays chosen, and that the interface does not shake.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "cutting/cut_scenes.h"
#include "model/matching/matching_step.h"
#include "pliant/error.h"
#include "solver/scenes.h"
#include "support/error_of.h"

namespace pliant {
namespace {

using namespace cut_test;

/// A standing block under its weight, with finite elements in its upper part.
Scene block(int width, int substeps, double damping = 20) {
  Body body = box_body("block", {0.05, 0.05, 0.05});
  body.material.set_moduli(Law::neo_hookean, Moduli::from_young(20000, 0.45));
  body.material.damping = damping;
  body.model.type = ModelType::hybrid;
  body.model.ratio = 0.4;
  body.model.seed = Vec3d{0.025, 0.05, 0.025};
  body.model.width = width;
  body.model.young = 20000;
  body.model.matched = true;
  body.model.substeps = substeps;
  hold(body, {0, 0.001, 0}, {0, -1, 0});
  Scene scene = scene_with(body);
  scene.gravity = {0, -9.81, 0};
  return scene;
}

Scene automatic_block(int width = 2) { return block(width, 0); }

std::unique_ptr<Simulation> run_of(const Scene& scene) { return std::make_unique<Simulation>(scene, open_backend("cpu")); }

TEST(AutomaticSubsteps, AreAsManyAsTheStiffnessAllows) {
  for (const int width : {2, 3, 4}) {
    const auto s = run_of(automatic_block(width));
    const FlsmBatch& batch = s->model().flsm.at(0);
    EXPECT_GT(batch.settings.substeps, 1) << width;
    EXPECT_TRUE(batch.settings.extrapolate);
    EXPECT_EQ(s->scene().bodies[0].model.substeps, batch.settings.substeps);
    EXPECT_TRUE(s->scene().bodies[0].model.extrapolate);
    const double longest = automatic_matching_step(batch, 20, true);
    EXPECT_LE(batch.settings.substeps * s->dt(), 1.00001 * longest);
    EXPECT_LT(longest, longest_matching_step(batch, 20));
  }
}

/// Time of a simulated second, with that of an element as the unit: a region takes some 3.5 times as long.
double cost(const Simulation& s) {
  const FlsmBatch& b = s.model().flsm.at(0);
  const double regions = 3.5 * (b.own + b.interface);
  return (static_cast<double>(s.model().bodies[0].operational_elements) + regions / b.settings.substeps) / s.dt();
}

/// Where their steps would be cut short, too many of them would cost more than they spare.
TEST(AutomaticSubsteps, SpareTime) {
  for (const int width : {1, 2, 3, 4, 5})
    EXPECT_LT(cost(*run_of(automatic_block(width))), 1.1 * cost(*run_of(block(width, 1)))) << width;
  for (const int width : {2, 3})
    EXPECT_LT(cost(*run_of(automatic_block(width))), 0.8 * cost(*run_of(block(width, 1)))) << width;
}

TEST(AutomaticSubsteps, AreThoseThatASceneMayGive) {
  const auto chosen = run_of(automatic_block());
  Scene scene = block(2, chosen->scene().bodies[0].model.substeps);
  scene.bodies[0].model.extrapolate = true;
  const auto given = run_of(scene);
  chosen->advance(300);
  given->advance(300);
  EXPECT_EQ(chosen->deep_hash(), given->deep_hash());
}

TEST(AutomaticSubsteps, FitAGivenStep) {
  Scene scene = automatic_block();
  const double dt = run_of(block(2, 1))->dt();
  for (const double share : {1.0, 0.5, 0.1}) {
    scene.dt = share * dt;
    const auto s = run_of(scene);
    const FlsmBatch& batch = s->model().flsm.at(0);
    EXPECT_LE(batch.settings.substeps * scene.dt, automatic_matching_step(batch, 20, true));
    EXPECT_TRUE(s->remarks().empty());
  }
}

TEST(AutomaticSubsteps, AreOneWhereMoreMayNotBe) {
  Scene touched = automatic_block();
  touched.contact = TissueContact{};
  EXPECT_EQ(run_of(touched)->model().flsm.at(0).settings.substeps, 1);
  Scene skinned = automatic_block();
  skinned.bodies[0].membrane = Membrane{};
  skinned.bodies[0].membrane->thickness = 1e-4;
  skinned.bodies[0].membrane->young = 1e4;
  EXPECT_EQ(run_of(skinned)->model().flsm.at(0).settings.substeps, 1);
  EXPECT_EQ(run_of(block(2, 0, 1))->model().flsm.at(0).settings.substeps, 1) << "too little damping";
  Scene given = automatic_block();
  given.bodies[0].model.beta = 1;
  EXPECT_EQ(run_of(given)->model().flsm.at(0).settings.substeps, 1);
  Scene alone = automatic_block();
  alone.bodies[0].model.type = ModelType::flsm;
  EXPECT_EQ(run_of(alone)->model().flsm.at(0).settings.substeps, 1);
}

TEST(AutomaticSubsteps, StayThroughChangesCutsAndResumption) {
  Scene scene = automatic_block();
  scene.blades.push_back(blade("knife", {{0.05, 0.02, 0.1, -1, 0.02, 0.1, 1}, {0.15, 0.02, -0.1, -1, 0.02, -0.1, 1}}));
  const auto s = run_of(scene);
  const int n = s->scene().bodies[0].model.substeps;
  ASSERT_GT(n, 1);
  s->change(R"({"material": {"young": 25000}})");
  while (s->topology_version() == 0 && s->step() < 5000) s->advance(64);
  ASSERT_GT(s->topology_version(), 0);
  EXPECT_EQ(s->scene().bodies[0].model.substeps, n);
  EXPECT_EQ(s->model().flsm.at(0).settings.substeps, n);
  const auto resumed = run_of(scene);
  resumed->restore(s->snapshot());
  EXPECT_EQ(resumed->deep_hash(), s->deep_hash());
  s->advance(200);
  resumed->advance(200);
  EXPECT_EQ(resumed->deep_hash(), s->deep_hash());
  const std::string refusal = test::error_of([&] { s->change(R"({"model": {"substeps": "auto"}})"); });
  EXPECT_NE(refusal.find("chosen when a scene begins"), std::string::npos) << refusal;
}

/// Root mean square of the velocities of a block that has come to rest [m/s].
double noise(const Scene& scene) {
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 1.5 && !s.divergence()) s.advance(64);
  double sum = 0;
  for (const Vec3d& v : s.velocities(0)) sum += vec::dot(v, v);
  return std::sqrt(sum / static_cast<double>(s.velocities(0).size()));
}

/// Near the longest step of shape matching extrapolated goals feed energy to the interface: 0.3 to 0.5 m/s here, and more than
/// its weight does.
TEST(AutomaticSubsteps, TheInterfaceComesToRestWithExtrapolatedGoals) {
  for (const int width : {1, 2, 3}) {
    const double quiet = noise(block(width, 1, 5));
    for (const int substeps : {0, 2, 4, 8}) {
      Scene scene = block(width, substeps, substeps > 0 ? 5 : 20);
      scene.bodies[0].model.extrapolate = substeps > 0;
      EXPECT_LT(noise(scene), 0.005 + 2 * quiet) << width << ' ' << substeps;
    }
  }
}

/// Blades keep the step at the bound of the elements, below what the choice expects.
TEST(AutomaticSubsteps, AreNotToldToShakeThemselves) {
  int several = 0;
  for (double damping = 2; damping < 40; damping *= 1.03) {
    Scene scene = block(2, 0, damping);
    scene.gravity = {};
    scene.blades.push_back(blade("knife", {{5, 0.02, 0.1, -1, 0.02, 0.1, 1}, {6, 0.02, -0.1, -1, 0.02, -0.1, 1}}));
    const auto s = run_of(scene);
    several += s->model().flsm.at(0).settings.substeps > 1;
    EXPECT_TRUE(s->remarks().empty()) << damping;
  }
  EXPECT_GT(several, 0);
}

TEST(AutomaticSubsteps, AGivenStepThatLetsTheInterfaceShakeIsTold) {
  Scene scene = block(1, 3, 40);
  scene.bodies[0].model.extrapolate = true;
  const auto safe = run_of(scene);
  EXPECT_TRUE(safe->remarks().empty());
  Scene longer = scene;
  longer.dt = 1.5 * safe->dt();
  Scene undamped = scene;
  undamped.bodies[0].material.damping = 0;
  for (const Scene& shaking : {longer, undamped}) {
    const std::vector<std::string> told = run_of(shaking)->remarks();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("may gain energy"), std::string::npos) << told[0];
  }
}

/// Goals before the first step of shape matching are where the nodes begin.
TEST(AutomaticSubsteps, NodesThatBeginDisplacedAreNotPulledBack) {
  const auto fastest = [](int substeps) {
    Scene scene = block(2, substeps);
    scene.gravity = {};
    scene.bodies[0].fixed.clear();
    scene.bodies[0].model.extrapolate = substeps > 1;
    scene.dt = 2e-4;
    Initial all;
    all.where.kind = Selection::Kind::all;
    all.displacement.offset = {0.05, 0, 0};
    scene.bodies[0].initial.push_back(all);
    Simulation s(scene, open_backend("cpu"));
    s.advance(8);
    double most = 0;
    for (const Vec3d& v : s.velocities(0)) most = std::max(most, vec::norm(v));
    return most;
  };
  EXPECT_LT(fastest(1), 1e-3);
  EXPECT_LT(fastest(4), 1e-3);
}

/// Which it may do with one substep, where there is more room.
TEST(AutomaticSubsteps, AStiffnessBeyondTheStepShortensIt) {
  Scene scene = automatic_block();
  scene.bodies[0].model.matched = false;
  const auto s = run_of(scene);
  s->advance(64);
  const double before = s->dt();
  s->change(R"({"model": {"stiffness": {"young": 200000}}})");
  s->advance(64);
  EXPECT_LT(s->dt(), 0.5 * before);
  EXPECT_FALSE(s->divergence());
}

}  // namespace
}  // namespace pliant
