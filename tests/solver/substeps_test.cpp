// Hybrids whose shape matching pulls at the finite elements once in several steps, and go on with one where that drives them
// apart.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "cutting/cut_scenes.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/step/coupling.h"
#include "solver/loaded.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using namespace cut_test;

/// A soft bar, undamped, that is sheared by two thirds of its length and cut through under that load.
Scene sheared_bar(bool extrapolate) {
  Body body = box_body("bar", {0.15, 0.05, 0.05});
  body.material.set_moduli(Law::neo_hookean, Moduli::from_young(1500, 0.4));
  body.model.type = ModelType::hybrid;
  body.model.substeps = 8;
  body.model.extrapolate = extrapolate;
  body.model.young = 1500;
  body.model.matched = true;
  hold(body, {0.005, 0, 0}, {-1, 0, 0});
  pull(body, {0.145, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, 0.2);
  Scene scene = scene_with(body);
  scene.blades.push_back(blade("knife", {{0.1, 0.07, -0.1, -0.2, 0.07, -0.1, 0.2}, {0.3, 0.07, 0.2, -0.2, 0.07, 0.2, 0.2}}));
  return scene;
}

/// Nothing else here makes a model anew.
Scene pressed_bar() {
  Scene scene = sheared_bar(true);
  scene.blades.clear();
  scene.bodies[0].prescribed[0].displacement = {-0.11, 0.03, 0};
  return scene;
}

double farthest(const Simulation& s) {
  double most = 0;
  for (const Vec3d& u : s.displacements(0)) most = std::max(most, vec::norm(u));
  return most;
}

TEST(Substeps, AHybridThatTheyDriveApartGoesOnWithOne) {
  for (const bool extrapolate : {false, true}) {
    Simulation s(sheared_bar(extrapolate), open_backend("cpu"));
    EXPECT_EQ(s.model().flsm.at(0).settings.substeps, 8);
    while (s.time() < 0.6 && s.step() < 5000) {  // about 1000; with 8 substeps 30000, and crumbs a kilometre away
      s.advance(64);
      ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    }
    EXPECT_GT(s.time(), 0.6);
    EXPECT_LT(farthest(s), 2);
    EXPECT_EQ(s.state().most_substeps, 1);
    EXPECT_EQ(s.model().flsm.at(0).settings.substeps, 1);
  }
}

TEST(Substeps, ARunResumesWithThoseThatItWentOnWith) {
  for (const Scene& scene : {sheared_bar(false), pressed_bar()}) {
    Simulation whole(scene, open_backend("cpu"));
    while (whole.state().most_substeps == 0 && whole.step() < 10000) whole.advance(32);
    ASSERT_EQ(whole.state().most_substeps, 1);
    const Snapshot there = whole.snapshot();
    Simulation resumed(scene, open_backend("cpu"));
    resumed.restore(there);
    EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
    whole.advance(200);
    resumed.advance(200);
    EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
    Simulation fresh(scene, open_backend("cpu"));
    whole.restore(fresh.snapshot());  // and back
    EXPECT_EQ(whole.model().flsm.at(0).settings.substeps, 8);
    EXPECT_EQ(whole.deep_hash(), fresh.deep_hash());
  }
}

/// Positions, velocities and the stiffness of shape matching are as before.
TEST(Substeps, NothingMovesWhenTheyBecomeFewer) {
  Scene scene = sheared_bar(false);
  scene.bodies[0].model.young = 0;
  scene.bodies[0].model.alpha = 0.8;
  scene.bodies[0].model.damping = 0.1;
  Loaded l(scene);
  l.settings.automatic = true;
  const LoadedModel& loaded = l.loaded;
  StepControl step(l.run);
  HostLoads loads(l.run);
  RunReport report;
  TopologyEdits edits(l.run, step, loads, report);
  std::vector<double> u = loaded.u(), w = loaded.w();
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (i % 4 == 3 || !loaded.free()[i / 4 * 3 + i % 4]) continue;
    u[i] = 1e-3 * std::sin(static_cast<double>(i));
    w[i] = 1e-4 * std::cos(static_cast<double>(i));
  }
  l.loaded.write_u(u);
  l.loaded.write_w(w);
  upload_coupling(l.run);
  const auto velocities = l.run.velocities(w, 0);
  const double modulus = matching_modulus(loaded.model().flsm[0], l.state.clock.dt, 0);
  ASSERT_TRUE(edits.fewer_substeps());
  EXPECT_EQ(loaded.model().flsm[0].settings.substeps, 1);
  const auto now = l.run.velocities(loaded.w(), 0);
  const auto moved = loaded.pick(loaded.u(), 0, 1), before = loaded.pick(u, 0, 1);
  double fastest = 0;
  for (std::size_t n = 0; n < now.size(); ++n) {
    fastest = std::max(fastest, vec::norm(now[n]));
    EXPECT_LT(vec::norm(vec::sub(now[n], velocities[n])), 1e-12) << n;
    EXPECT_LT(vec::norm(vec::sub(moved[n], before[n])), 1e-15) << n;
  }
  EXPECT_GT(fastest, 0.02);
  EXPECT_NEAR(matching_modulus(loaded.model().flsm[0], l.state.clock.dt, 0) / modulus, 1, 1e-12);
  EXPECT_NEAR(std::pow(1 - loaded.model().flsm[0].settings.damping, 8), 0.9, 1e-12);
  EXPECT_FALSE(edits.fewer_substeps()) << "there is one already";
}

TEST(Substeps, StayWhereAMeshFileHasGone) {
  Simulation first(pressed_bar(), open_backend("cpu"));
  while (first.state().most_substeps == 0 && first.step() < 10000) first.advance(32);
  const test::TempFolder folder;
  Scene scene = pressed_bar();
  const TriangleMesh& box = *scene.bodies[0].surface_in_memory;
  std::string text;
  for (const Vec3d& v : box.vertices) text += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
  for (const auto& t : box.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const std::filesystem::path file = folder.write("bar.obj", text);
  scene.bodies[0].surface = file;
  scene.bodies[0].surface_in_memory = nullptr;
  Simulation s(scene, open_backend("cpu"));
  std::filesystem::remove(file);
  EXPECT_NO_THROW(s.advance(first.step() + 64));
  EXPECT_FALSE(s.divergence());
  EXPECT_EQ(s.state().most_substeps, 0);
}

TEST(Substeps, StayWhereTheStepIsGiven) {
  Scene scene = sheared_bar(true);
  Simulation automatic(scene, open_backend("cpu"));
  scene.dt = automatic.dt();
  Simulation given(scene, open_backend("cpu"));
  given.advance(5000);
  EXPECT_EQ(given.model().flsm.at(0).settings.substeps, 8);
}

}  // namespace
}  // namespace pliant
