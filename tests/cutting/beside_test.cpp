// Edits whose models are built beside the steps: what goes on meanwhile, and what is there once they are taken up.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "io/save.h"
#include "pliant/error.h"
#include "solver/scenes.h"
#include "support/forwarding_backend.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using namespace cut_test;

class Beside : public ::testing::TestWithParam<ElementKind> {};
INSTANTIATE_TEST_SUITE_P(Cutting, Beside,
                         ::testing::Values(ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4, ElementKind::tet4anp),
                         [](const auto& element) { return std::string(to_string(element.param)); });

Body bar(ElementKind element = ElementKind::hex8) { return box_body("box", {0.06, 0.04, 0.03}, element); }

std::unique_ptr<Simulation> beside(const Scene& scene, std::unique_ptr<Backend> backend = open_backend("cpu")) {
  auto s = std::make_unique<Simulation>(scene, std::move(backend));
  s->edits().build_beside(true);
  return s;
}

TEST_P(Beside, StepsGoOnAndNothingIsLostWhenTheModelIsTakenUp) {
  Body body = bar(GetParam());
  body.velocity = {0.005, -0.02, 0.01};
  body.angular_velocity = {0.3, 0.5, -0.4};
  const auto s = beside(scene_with(body));
  const double mass = mass_of(*s);
  const std::size_t nodes = s->model().bodies[0].rest.size();
  std::int64_t version = 0;
  for (const double at : {0.031, 0.045, 0.018, 0.035}) {
    s->advance(25);
    const std::shared_ptr<const Model> old = s->shared_model();
    const CutReport begun = s->cut(wall(at, at < 0.033 ? 0.4 : -0.2));
    EXPECT_TRUE(begun.pending && !begun.changed);
    EXPECT_EQ(s->advance(40), 40);
    EXPECT_TRUE(s->edits().building());
    EXPECT_EQ(s->shared_model(), old);
    EXPECT_EQ(s->topology_version(), version);
    const Vec3d before = momentum_of(*s);
    const std::vector<Vec3d> u = s->displacements(0);
    const std::optional<CutReport> done = s->edits().take_built(true);
    ASSERT_TRUE(done && done->changed && done->asked);
    EXPECT_FALSE(s->edits().building());
    EXPECT_EQ(s->topology_version(), ++version);
    EXPECT_GT(done->edges, 0);
    EXPECT_NEAR(mass_of(*s), mass, 1e-12 * mass);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(momentum_of(*s)[c], before[c], 2e-6 * 0.03 * mass);
    for (std::size_t n = 0; n < nodes; ++n) EXPECT_EQ(s->displacements(0)[n], u[n]) << "a node of the uncut body has moved";
    check_body(*s->cut_topology(0), false);
  }
  EXPECT_GE(s->cut_topology(0)->pieces(), 3);
  EXPECT_EQ(s->advance(200), 200) << (s->divergence() ? s->divergence()->message() : "");
}

/// Of a body at rest, which a blade cuts alike at any time.
TEST_P(Beside, TheModelIsThatOfAnEditThatWaits) {
  const Scene scene = scene_with(bar(GetParam()));
  Simulation waits(scene, open_backend("cpu"));
  const auto s = beside(scene);
  for (const double at : {0.031, 0.018}) {
    s->cut(wall(at, 0.2));
    s->advance(64);
    s->edits().take_built(true);
    waits.advance(64);
    waits.cut(wall(at, 0.2));
    EXPECT_EQ(s->deep_hash(), waits.deep_hash()) << at;
  }
}

TEST(Beside, ABladeThatGoesOnCutsWhatItHasSweptMeanwhile) {
  const auto s = beside(scene_with(bar()));
  const auto at = [](double y) { return BladeSegment{{{0.031, y, -1}, {0.031, y, 1}}}; };
  s->move_blade("knife", at(-0.01));
  ASSERT_TRUE(s->move_blade("knife", at(0.016)).pending);
  s->advance(64);
  ASSERT_TRUE(s->move_blade("knife", at(0.06)).pending);  // waits for the one before, and loads it
  const std::optional<CutReport> first = s->edits().take_built(false);
  ASSERT_TRUE(first && first->changed);
  EXPECT_EQ(s->topology_version(), 1);
  ASSERT_TRUE(s->edits().building());
  EXPECT_TRUE(s->edits().take_built(true)->changed);
  EXPECT_EQ(s->cut_topology(0)->pieces(), 2);
}

TEST(Beside, AModelThatHasChangedMeanwhileIsBuiltAgain) {
  Scene scene = scene_with(bar());
  scene.contact = TissueContact{};
  ContactTool tool;
  tool.name = "ball";
  tool.radius = 0.01;
  tool.path = {{0, 0.03, 0.08, 0.015, 0, 0, 0, 1}};
  scene.tools.push_back(tool);
  Simulation waits(scene, open_backend("cpu"));
  const auto s = beside(scene);
  s->cut(wall(0.031));
  s->tools().park("ball");
  s->advance(64);
  EXPECT_TRUE(s->edits().take_built(true)->changed);
  EXPECT_TRUE(s->contact().tools().empty());
  waits.tools().park("ball");
  waits.advance(64);
  waits.cut(wall(0.031));
  EXPECT_EQ(s->deep_hash(), waits.deep_hash());
}

/// It replaces no model, but the scene that the builder reads.
TEST(Beside, AChangeOfGravityComesAfterIt) {
  const auto s = beside(scene_with(bar()));
  s->cut(wall(0.031));
  s->change(R"({"gravity": [0, -1, 0]})");
  EXPECT_FALSE(s->edits().building());
  EXPECT_TRUE(s->edits().take_built(false)->changed);
}

TEST(Beside, AChangeOfParametersComesAfterIt) {
  const Scene scene = scene_with(bar());
  Simulation waits(scene, open_backend("cpu"));
  const auto s = beside(scene);
  const std::string stiffer = R"({"body": "box", "material": {"young": 9000}})";
  s->cut(wall(0.031));
  s->change(stiffer);
  EXPECT_FALSE(s->edits().building());
  const std::optional<CutReport> done = s->edits().take_built(false);
  EXPECT_TRUE(done && done->changed);
  EXPECT_FALSE(s->edits().take_built(true));
  s->cut(wall(0.018));
  s->change(stiffer);
  s->cut(wall(0.045));
  s->change(stiffer);  // two reports wait now
  EXPECT_FALSE(s->edits().building());
  EXPECT_TRUE(s->edits().take_built(false)->changed);
  EXPECT_TRUE(s->edits().take_built(false)->changed);
  EXPECT_FALSE(s->edits().take_built(true));
  for (const double at : {0.031, 0.018, 0.045}) {
    waits.cut(wall(at));
    waits.change(stiffer);
  }
  s->advance(64);
  waits.advance(64);
  EXPECT_EQ(s->deep_hash(), waits.deep_hash());
}

TEST(Beside, AStateThatIsRestoredIsWithoutIt) {
  const auto s = beside(scene_with(bar()));
  s->advance(64);
  const Snapshot before = s->snapshot();
  const std::uint64_t hash = s->deep_hash();
  s->cut(wall(0.031));
  s->restore(before);
  EXPECT_FALSE(s->edits().building());
  EXPECT_EQ(s->deep_hash(), hash);
  s->cut(wall(0.031));
  s->advance(64);
  EXPECT_TRUE(s->edits().take_built(true)->changed);
  EXPECT_EQ(s->cut_topology(0)->pieces(), 2);
}

TEST(Beside, ASimulationEndsWhileItIsBuilt) {
  for (int i = 0; i < 20; ++i) {
    const auto s = beside(scene_with(bar()));
    s->cut(wall(0.031));
  }
}

/// Refuses as many models as it is told to.
class Full : public test::ForwardingBackend {
 public:
  Full(std::unique_ptr<Backend> inner, int& refusals) : ForwardingBackend(std::move(inner)), refusals_(refusals) {}
  void update(const Program& loaded, const Program& next) override {
    if (refusals_-- > 0) throw Error(ErrorCode::device, "the device is full");
    ForwardingBackend::update(loaded, next);
  }

 private:
  int& refusals_;
};

TEST(Beside, AnEditThatIsRefusedChangesNothing) {
  int refusals = 0;
  const Scene scene = scene_with(bar());
  const auto s = beside(scene, std::make_unique<Full>(open_backend("cpu"), refusals));
  s->cut(wall(0.018));
  s->advance(64);
  s->edits().take_built(true);
  const std::uint64_t hash = s->hash();
  s->move_blade("knife", {{{0.045, -0.01, -1}, {0.045, -0.01, 1}}});
  const auto blades = s->state().blades.placed;
  refusals = 2;
  s->move_blade("knife", {{{0.045, 0.02, -1}, {0.045, 0.02, 1}}});
  EXPECT_THROW(s->edits().take_built(true), Error);
  EXPECT_EQ(s->state().blades.placed, blades);
  EXPECT_TRUE(s->state().blades.traces.empty());
  s->cut(wall(0.031));
  s->change(R"({"gravity": [0, 0, 0]})");  // what is refused then is not this
  EXPECT_THROW(s->edits().take_built(true), Error);
  EXPECT_FALSE(s->edits().building());
  EXPECT_EQ(s->hash(), hash);
  EXPECT_EQ(s->cut_topology(0)->pieces(), 2);
  refusals = 0;
  s->cut(wall(0.031));
  EXPECT_TRUE(s->edits().take_built(true)->changed);
  EXPECT_EQ(s->cut_topology(0)->pieces(), 3);
}

/// A region follows the blade of the scene; edges that are stretched far open, too. One edit at a time is under way.
TEST(Beside, WhatIsDueAtOnceComesOneAfterTheOther) {
  Body body = bar();
  body.model.type = ModelType::hybrid;
  body.model.ratio = 0.5;
  body.model.follow = "scalpel";
  Scene scene = scene_with(body);
  scene.break_stretch = 1.2;
  pull(scene.bodies[0], {0.055, 0, 0}, {1, 0, 0}, {0.01, 0, 0}, 0.1);
  hold(scene.bodies[0], {0.005, 0, 0}, {-1, 0, 0});
  scene.blades.push_back(blade("scalpel", {{0, 0.031, -0.02, -1, 0.031, -0.02, 1}, {0.15, 0.031, 0.06, -1, 0.031, 0.06, 1}}));
  const auto s = beside(scene);
  std::int64_t edits = 0, moves = 0;
  const auto take = [&](bool wait) {
    while (const std::optional<CutReport> done = s->edits().take_built(wait)) {
      (done->edges > 0 ? edits : moves) += done->changed ? 1 : 0;
    }
  };
  while (s->time() < 0.25 && !s->divergence()) {
    s->advance(s->next_batch(64));
    take(edits % 2 == 0);
  }
  for (int i = 0; i < 4; ++i) {  // what was due while an edit was being built
    take(true);
    s->advance(s->next_batch(64));
  }
  take(true);
  EXPECT_GE(edits, 2);
  EXPECT_GT(moves, 0);
  EXPECT_GE(s->cut_topology(0)->pieces(), 2);
  check_body(*s->cut_topology(0), false);
}

/// Counts the kernels of changed models that were not compiled before.
class CountsKernels : public test::ForwardingBackend {
 public:
  using ForwardingBackend::ForwardingBackend;
  void load(const Program& program) override {
    add(program);
    ForwardingBackend::load(program);
  }
  void compile_beside(const Program& program) override { add(program); }
  void update(const Program& loaded, const Program& next) override {
    late += add(next);
    ForwardingBackend::update(loaded, next);
  }
  std::size_t late = 0;

  std::size_t known() const { return known_.size(); }

 private:
  std::size_t add(const Program& program) {
    const std::size_t before = known_.size();
    for (const auto* passes : {&program.step, &program.look, &program.force, &program.rates, &program.status}) {
      for (const Pass& pass : *passes) known_.emplace(pass.kernel, pass.defines);
    }
    return known_.size() - before;
  }
  std::set<std::pair<std::string, std::vector<std::pair<std::string, int>>>> known_;
};

/// The first cut of a lattice brings elements of another kind.
TEST(Beside, KernelsOfTheNewModelAreCompiledBeforeItIsTakenUp) {
  auto counting = std::make_unique<CountsKernels>(open_backend("cpu"));
  const CountsKernels& kernels = *counting;
  const auto s = beside(scene_with(bar()), std::move(counting));
  s->advance(1);
  const std::size_t known = kernels.known();
  s->cut(wall(0.031));
  ASSERT_TRUE(s->edits().take_built(true)->changed);
  EXPECT_GT(kernels.known(), known);
  EXPECT_EQ(kernels.late, 0U);
}

/// A free bar 0.2 m long that bends and turns while the tool goes along it, with substeps of shape matching.
TEST(Beside, ARegionThatMovesKeepsMomentumAndPlaces) {
  const Scene scene = parse_scene(
      R"({"format": "pliant-scene/1", "focus": {"path": [[0, -0.08, 0, 0], [0.2, 0.08, 0, 0]]},
    "bodies": [{"name": "bar", "surface": "meshes/cylinder.obj", "lattice": {"spacing": 0.01}, "element": "hex8",
      "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000},
      "velocity": [0.1, 0, 0], "angular_velocity": [0, 2, 1],
      "model": {"type": "hybrid", "ratio": 0.3, "follow": "focus", "goals": "extrapolated", "substeps": 2}}]})",
      test::source_dir() + "/scenes/beside.json");
  const auto s = beside(scene);
  int moves = 0;
  while (s->time() < 0.2) {
    s->advance(s->next_batch(64));
    const std::vector<Vec3d> u = s->displacements(0);
    const Vec3d p = momentum_of(*s, true);
    const std::vector<MovedRegion> regions = s->state().regions;
    const std::size_t ballast = s->state().ballast.size();
    const std::optional<CutReport> done = s->edits().take_built(true);
    EXPECT_EQ(done.has_value(), s->state().regions != regions);
    // Inertia that elements give back takes its momentum along, and has nothing to do with the region.
    if (!done || s->state().ballast.size() != ballast) continue;
    EXPECT_FALSE(done->asked);
    ++moves;
    const std::vector<Vec3d> now = s->displacements(0);
    double jump = 0;
    for (std::size_t n = 0; n < u.size(); ++n) jump = std::max(jump, vec::norm(vec::sub(now[n], u[n])));
    EXPECT_LE(jump, std::ldexp(1.0, -28));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(momentum_of(*s, true)[c], p[c], 1e-6 * vec::norm(p));
  }
  EXPECT_GE(moves, 2);
}

}  // namespace
}  // namespace pliant
