// All scenes under the checking backend: no pass reads what none has written or writes where it may not, and the bits are those
// of "cpu". The scenes are hurried, so that in a few steps they pass what changes buffers and passes: ends of batches, cuts,
// tears, regions that move, changes of relaxation and of the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "scene/scene.h"
#include "solver/scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

constexpr std::int32_t kBatch = 8;
constexpr std::int64_t kSteps = 27;    // three batches and a part of one: beyond a look for tears
constexpr std::int64_t kRelaxed = 70;  // beyond the second look of dynamic relaxation, which is the first that changes anything

struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t edits = 0, step = 0;
  bool diverged = false, relaxed = false;
};

Outcome run(const Scene& scene, const std::shared_ptr<const Model>& model, const std::string& backend, std::int64_t steps) {
  SimulationOptions options;
  options.batch_steps = kBatch;
  Simulation s(scene, model, open_backend(backend), options);
  s.advance(steps / 2);
  (void)s.surface_positions();
  s.advance(steps - s.step());
  return {s.hash(), s.topology_version(), s.step(), s.divergence().has_value(), s.state().relaxation.damping > 0};
}

/// Runs it on both backends; returns what came out under the check.
Outcome expect_nothing_found(const Scene& scene, std::int64_t steps = kSteps) {
  const auto model = std::make_shared<const Model>(build_model(scene));
  Outcome checked, plain;
  EXPECT_NO_THROW(checked = run(scene, model, "cpu:check", steps));
  EXPECT_NO_THROW(plain = run(scene, model, "cpu", steps));
  EXPECT_EQ(checked.hash, plain.hash);
  EXPECT_EQ(checked.step, plain.step);
  EXPECT_EQ(checked.edits, plain.edits);
  return checked;
}

/// Blades go through at once, and what tears is weak and pulled quickly.
void hurry(Scene& scene) {
  double last = 0;
  for (const Blade& blade : scene.blades) last = std::max(last, blade.path.back()[0]);
  for (Blade& blade : scene.blades) {
    for (auto& row : blade.path) row[0] *= 0.01 / last;
  }
  for (Body& body : scene.bodies) {
    bool tears = body.material.toughness > 0;
    for (Inclusion& part : body.inclusions) tears = tears || part.material.toughness > 0;
    if (!tears) continue;
    for (Inclusion& part : body.inclusions) part.material.toughness /= 50;
    body.material.toughness /= 50;
    for (Prescribed& pull : body.prescribed) pull.curve.duration = 0.01;
  }
}

bool can_be_cut_or_tear(const Scene& scene) {
  const auto weak = [](const Body& body) {
    return body.material.toughness > 0 || std::any_of(body.inclusions.begin(), body.inclusions.end(),
                                                      [](const Inclusion& part) { return part.material.toughness > 0; });
  };
  return !scene.blades.empty() || std::any_of(scene.bodies.begin(), scene.bodies.end(), weak);
}

TEST(CheckScenes, NoShippedSceneReadsOrWritesWhatItMayNot) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() + "/scenes")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".json" || name == "schema") continue;
    SCOPED_TRACE(name);
    Scene scene = load_scene(entry.path());
    if (scene.solver.enabled) continue;
    const auto absent = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                     [](const Body& b) { return !b.surface.empty() && !std::filesystem::exists(b.surface); });
    if (absent != scene.bodies.end()) {
      std::cout << "             " << name << " is left out: " << absent->surface.string() << " is absent\n";
      continue;
    }
    hurry(scene);
    const Outcome outcome = expect_nothing_found(scene, scene.relaxation.enabled ? kRelaxed : kSteps);
    EXPECT_TRUE(!can_be_cut_or_tear(scene) || outcome.edits > 0);
    EXPECT_TRUE(!scene.relaxation.enabled || outcome.relaxed);
    ++scenes;
  }
  EXPECT_GE(scenes, 24);
}

/// A cube pressed down from above, with finite elements in its upper part.
Scene hybrid_cube(int substeps, bool extrapolate, double damping, double beta) {
  Scene scene = testing::pressed_cube(0.01);
  DeformationModel& m = scene.bodies[0].model;
  m.type = ModelType::hybrid;
  m.ratio = 0.6;
  m.seed = Vec3d{0, 0.05, 0};
  m.substeps = substeps;
  m.extrapolate = extrapolate;
  m.damping = damping;
  m.beta = beta;
  return scene;
}

TEST(CheckScenes, NothingIsFoundInHybridsThatNoShippedSceneHas) {
  for (const int substeps : {1, 3}) {
    for (const bool extrapolate : {false, true}) {
      for (const double beta : {0.0, 1.0}) {  // a given beta has a reaction
        SCOPED_TRACE(std::to_string(substeps) + " substeps, extrapolated " + std::to_string(extrapolate) + ", beta " +
                     std::to_string(beta));
        expect_nothing_found(hybrid_cube(substeps, extrapolate, 0.2, beta));
      }
    }
  }
}

TEST(CheckScenes, NothingIsFoundInOtherModelsLoadsAndIntegrators) {
  Scene matched = testing::pressed_cube(0.01);
  matched.bodies[0].model.type = ModelType::flsm;
  matched.bodies[0].model.damping = 0.1;
  expect_nothing_found(matched);

  Scene pressed = hybrid_cube(2, true, 0, 0);
  Pressure pressure;
  pressure.pressure = 20;
  pressed.bodies[0].pressures = {pressure};
  expect_nothing_found(pressed);

  Scene textbook = testing::pressed_cube(0.01);
  textbook.integrator = Integrator::textbook;
  expect_nothing_found(textbook);

  // Elements turn inside out: they go on, or the step is made smaller again and again.
  Scene inverted = testing::pressed_cube(0.12, "", 3000, "neo-hookean", 0.05);
  EXPECT_FALSE(expect_nothing_found(inverted, 80).diverged);
  inverted.inverted = Inverted::stop;
  EXPECT_TRUE(expect_nothing_found(inverted, 600).diverged);
}

}  // namespace
}  // namespace pliant
