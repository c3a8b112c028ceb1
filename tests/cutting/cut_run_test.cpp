// Cuts of running simulations: what they keep, both backends, checkpoints, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "io/save.h"
#include "pliant/error.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"

namespace pliant {
namespace {

using namespace cut_test;

class CutRun : public ::testing::TestWithParam<ElementKind> {};
INSTANTIATE_TEST_SUITE_P(Cutting, CutRun,
                         ::testing::Values(ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4, ElementKind::tet4anp),
                         [](const auto& element) { return std::string(to_string(element.param)); });

TEST_P(CutRun, AMovingBodyKeepsMassAndMomentumAtEveryCut) {
  Body body = box_body("box", {0.06, 0.04, 0.03}, GetParam());
  body.velocity = {0.005, -0.02, 0.01};
  body.angular_velocity = {0.3, 0.5, -0.4};
  Simulation s(scene_with(body), open_backend("cpu"));
  const double mass = mass_of(s), bound = s.model().element_bound;
  const std::size_t nodes = s.model().bodies[0].rest.size();
  std::int64_t version = 0;
  for (const double at : {0.031, 0.045, 0.018, 0.035}) {
    s.advance(25);
    const Vec3d before = momentum_of(s);
    const std::vector<Vec3d> u = s.displacements(0);
    const CutReport report = s.cut(wall(at, at < 0.033 ? 0.4 : -0.2));
    EXPECT_TRUE(report.changed);
    EXPECT_EQ(s.topology_version(), ++version);
    EXPECT_NEAR(mass_of(s), mass, 1e-12 * mass);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(momentum_of(s)[c], before[c], 2e-6 * 0.03 * mass);
    EXPECT_EQ(s.model().element_bound, bound);
    for (std::size_t n = 0; n < nodes; ++n) EXPECT_EQ(s.displacements(0)[n], u[n]) << "a node of the uncut body has moved";
    check_body(*s.cut_topology(0), false);
  }
  EXPECT_GE(s.cut_topology(0)->pieces(), 3);
  EXPECT_EQ(s.advance(200), 200) << (s.divergence() ? s.divergence()->message() : "");
}

TEST_P(CutRun, TheStableStepDoesNotShrink) {
  Simulation s(scene_with(box_body("box", {0.05, 0.04, 0.03}, GetParam())), open_backend("cpu:double"));
  const double before = s.estimate_stable_dt(), bound = s.model().element_bound;
  EXPECT_GE(before, 0.99 * bound);
  double least = before;
  for (const double at : {0.0213, 0.03, 0.0101, 0.0299, 0.0399999}) {
    s.cut(wall(at, at == 0.0213 ? 0.3 : 0));
    least = std::min(least, s.estimate_stable_dt());
    EXPECT_GE(least, 0.99 * bound);
    EXPECT_EQ(s.model().element_bound, bound);
  }
  std::printf("%s: element bound %.4g s, Lanczos %.4g s uncut, least after cuts %.4g s\n", to_string(GetParam()), bound, before,
              least);
}

TEST_P(CutRun, APieceThatNothingHoldsFalls) {
  Body body = box_body("box", {0.06, 0.02, 0.02}, GetParam());
  Selection end;
  end.kind = Selection::Kind::box;
  end.a = {-1, -1, -1};
  end.b = {0.001, 1, 1};
  body.fixed.push_back({end});
  Scene scene = scene_with(body);
  scene.gravity = {0, -9.81, 0};
  scene.blades.push_back(blade("scalpel", {{0, 0.034, -0.03, -1, 0.034, -0.03, 1}, {0.02, 0.034, 0.05, -1, 0.034, 0.05, 1}}));
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.06) s.advance(64);
  ASSERT_EQ(s.cut_topology(0)->pieces(), 2);
  double held = 0, loose = 0;
  const std::vector<Vec3d> u = s.displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double x = s.model().bodies[0].rest[n][0];
    if (x < 0.0201) held = std::min(held, u[n][1]);
    if (x > 0.0599) loose = std::min(loose, u[n][1]);
  }
  EXPECT_LT(loose, -0.004) << "free fall for 40 ms is 7.8 mm";
  EXPECT_GT(held, loose / 2);
}

/// A virtual node moves until a cut leaves it held anchors only. Nothing moves it from then on, nor may what it did before, and
/// it does not jump.
TEST_P(CutRun, AVirtualNodeThatBecomesHeldRests) {
  Body body = box_body("box", {0.06, 0.02, 0.02}, GetParam());
  Selection end;
  end.kind = Selection::Kind::box;
  end.a = {-1, -1, -1};
  end.b = {0.011, 1, 1};
  body.fixed.push_back({end});
  Scene scene = scene_with(body);
  scene.gravity = {3, 0, -9.81};
  Simulation s(scene, open_backend("cpu"));
  s.cut(sweep({{{-1, -1, 0.0152}, {-1, 1, 0.0152}}}, {{{1, -1, 0.0152}, {1, 1, 0.0152}}}));
  s.advance(60);
  const auto held_nodes = [&] {
    std::vector<std::size_t> nodes;
    for (const Constraint& c : s.model().constraints) {
      const std::vector<std::int32_t>& slot = s.model().bodies[0].slot;
      if (c.holds()) nodes.push_back(static_cast<std::size_t>(std::find(slot.begin(), slot.end(), c.slot) - slot.begin()));
    }
    return nodes;
  };
  const std::size_t before = held_nodes().size();
  double moved = 0;
  for (std::size_t n = 0; n < s.model().bodies[0].rest.size(); ++n) {
    if (s.model().bodies[0].rest[n][0] < 0.011) moved = std::max(moved, vec::norm(s.displacements(0)[n]));
  }
  s.cut(wall(0.0122));
  ASSERT_GT(held_nodes().size(), before);
  ASSERT_GT(moved, 1e-5);
  const std::vector<Vec3d> there = s.displacements(0);
  s.advance(60);
  const std::vector<Vec3d> u = s.displacements(0), v = s.velocities(0);
  double farthest = 0;
  for (const std::size_t n : held_nodes()) {
    EXPECT_EQ(u[n], there[n]) << n;
    EXPECT_EQ(v[n], Vec3d{}) << n;
    farthest = std::max(farthest, vec::norm(u[n]));
  }
  EXPECT_GT(farthest, 1e-5) << "no virtual node rests where it was";
}

/// What falls freely gains the momentum of its weight, whatever inertia its thin cells were given.
TEST_P(CutRun, TheInertiaOfThinCellsHasNoWeight) {
  Body body = box_body("box", {0.06, 0.04, 0.03}, GetParam());
  body.angular_velocity = {0.3, 0.5, -0.4};
  Scene scene = scene_with(body);
  scene.gravity = {1, -9.81, 2};
  Simulation s(scene, open_backend("cpu"));
  const double mass = mass_of(s);
  EXPECT_EQ(s.model().bodies[0].added_mass, 0) << "nothing says that this body will be cut";
  s.cut(wall(0.0302));  // leaves a fiftieth of a cell
  s.cut(wall(0.045, 0.4));
  double added = 0, least = 1;
  for (const double m : s.model().added) added += m;
  for (const double fill : s.cut_topology(0)->elements().fill) least = std::min(least, fill);
  EXPECT_LT(least, 0.04);
  EXPECT_GT(added, 1e-4 * mass);
  EXPECT_LT(added, 0.3 * mass);
  EXPECT_NEAR(s.model().bodies[0].added_mass, added, 1e-12 * mass);
  EXPECT_NEAR(mass_of(s), mass, 1e-12 * mass);
  s.advance(1);
  const Vec3d before = momentum_of(s, true);
  const double start = s.time();
  s.advance(500);
  const double gained = mass * (s.time() - start);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(momentum_of(s, true)[c] - before[c], gained * scene.gravity[c], 1e-3 * gained * 9.81);
}

TEST(CutRun, VirtualNodesOfALoosePieceAreNotFixed) {
  Body body = box_body("box", {0.04, 0.02, 0.02});
  Selection end;
  end.kind = Selection::Kind::box;
  end.a = {-1, -1, -1};
  end.b = {0.001, 1, 1};
  body.fixed.push_back({end});
  Simulation s(scene_with(body), open_backend("cpu"));
  const std::size_t fixed = s.model().constraints.size();
  s.cut(wall(0.005));
  EXPECT_EQ(s.model().constraints.size(), fixed);
  Body plane = box_body("box", {0.04, 0.02, 0.02});
  plane.fixed.push_back({Selection{}, {false, false, true}});
  Simulation strain(scene_with(plane), open_backend("cpu"));
  strain.cut(wall(0.005));
  EXPECT_EQ(strain.model().constraints.size(), strain.model().bodies[0].rest.size());
}

Scene five_cuts(ModelType type, ElementKind element) {
  Body body = box_body("box", {0.08, 0.03, 0.03}, element);
  body.model.type = type;
  body.model.width = 1;
  body.model.ratio = 0.5;
  body.angular_velocity = {1, 3, -2};
  Scene scene = scene_with(body);
  scene.gravity = {0, -9.81, 0};
  const double t = 0.006;
  for (int k = 0; k < 5; ++k) {
    const double x = 0.013 + 0.0137 * k, start = t * k;
    scene.blades.push_back(blade("blade" + std::to_string(k), {{start, x, -0.02, -1, x + 0.01, -0.02, 1},
                                                               {start + 1.3 * t, x, 0.08, -1, x + 0.01, 0.08, 1}}));
  }
  return scene;
}

class CutModels : public ::testing::TestWithParam<std::tuple<ModelType, ElementKind>> {};
INSTANTIATE_TEST_SUITE_P(Cutting, CutModels,
                         ::testing::Values(std::tuple(ModelType::tled, ElementKind::hex8),
                                           std::tuple(ModelType::tled, ElementKind::tet4anp),
                                           std::tuple(ModelType::hybrid, ElementKind::hex8),
                                           std::tuple(ModelType::hybrid, ElementKind::tet4),
                                           std::tuple(ModelType::flsm, ElementKind::hex8)));

SimulationOptions short_batches() {
  SimulationOptions options;
  options.batch_steps = 16;
  options.dt = 2e-4;
  return options;
}

TEST_P(CutModels, BothBackendsAgreeThrough200StepsWith5Cuts) {
  if (!testing::has_opencl()) GTEST_SKIP() << "no OpenCL device";
  const Scene scene = five_cuts(std::get<0>(GetParam()), std::get<1>(GetParam()));
  Simulation a(scene, open_backend("cpu"), short_batches()), b(scene, open_backend("opencl:0"), short_batches());
  CompareOptions options;
  options.steps = 200;
  options.every_pass = false;
  const ComparisonResult result = compare(a, b, options);
  EXPECT_TRUE(result.identical) << (result.first_difference ? result.first_difference->message() : "");
  EXPECT_GE(a.topology_version(), 5);
  EXPECT_EQ(a.topology_version(), b.topology_version());
  EXPECT_FALSE(a.divergence());
}

TEST_P(CutModels, ARunResumedBetweenCutsHasTheSameBits) {
  const Scene scene = five_cuts(std::get<0>(GetParam()), std::get<1>(GetParam()));
  Simulation whole(scene, open_backend("cpu"), short_batches());
  whole.advance(75);
  const Checkpoint saved = take_checkpoint(whole);
  const std::int64_t version = whole.topology_version();
  EXPECT_GE(version, 1);
  whole.advance(125);
  EXPECT_GT(whole.topology_version(), version);
  Simulation resumed(scene, open_backend("cpu"), short_batches());
  restore_checkpoint(resumed, saved, "saved");
  EXPECT_EQ(resumed.topology_version(), version);
  resumed.advance(125);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(whole.topology_version(), resumed.topology_version());
  EXPECT_EQ(whole.surface_positions(), resumed.surface_positions());
  expect_same(whole.cut_topology(0)->elements(), resumed.cut_topology(0)->elements());
}

TEST(CutRun, CopiesOfAnInterfaceNodeShareItsBetaLikeItsMass) {
  Scene scene = five_cuts(ModelType::hybrid, ElementKind::hex8);
  scene.blades.clear();
  scene.bodies[0].model.beta = 100;
  scene.dt = 2e-4;
  Simulation s(scene, open_backend("cpu:double"));
  struct Spring {
    Vec3d place;
    double beta, mass;
  };
  const auto springs = [&] {
    const FlsmBatch& b = s.model().flsm[0];
    const ModelBody& body = s.model().bodies[0];
    const std::vector<double> beta = s.backend().read_reals(s.program().find("flsm_beta/0"));
    std::vector<Spring> all;
    for (std::int32_t i = 0; i < b.interface; ++i) {
      const std::int32_t slot = b.slot[b.own + i];
      const auto node = std::find(body.slot.begin(), body.slot.end(), slot) - body.slot.begin();
      all.push_back({body.rest[static_cast<std::size_t>(node)], beta[i], s.model().mass[static_cast<std::size_t>(slot)]});
    }
    return all;
  };
  std::map<Vec3d, double> whole;  // mass
  for (const Spring& k : springs()) {
    EXPECT_EQ(k.beta, 100);
    whole[k.place] = k.mass;
  }
  const std::size_t interface = whole.size();
  const double step = s.estimate_stable_dt();
  // Along the body, through the middle of its cells: every interface node beside the cut has a copy.
  s.cut(sweep({{{-1, 0.0151, -1}, {-1, 0.0151, 1}}}, {{{1, 0.0151, -1}, {1, 0.0151, 1}}}));
  const std::vector<Spring> cut = springs();
  EXPECT_GT(cut.size(), interface);
  for (const Spring& k : cut) EXPECT_NEAR(k.beta, 100 * k.mass / whole.at(k.place), 1e-9) << k.place[0];
  EXPECT_GE(s.estimate_stable_dt(), 0.99 * std::min(step, s.model().element_bound));
}

TEST(CutRun, ASceneCanForbidCutsOfItsShapeMatchingPart) {
  Scene scene = five_cuts(ModelType::flsm, ElementKind::hex8);
  scene.bodies[0].model.cut = false;
  scene.blades.clear();
  Simulation s(scene, open_backend("cpu"));
  const std::uint64_t before = s.hash();
  EXPECT_EQ(s.cut(wall(0.033)).edges, 0);
  EXPECT_EQ(s.topology_version(), 0);
  EXPECT_EQ(s.hash(), before);
}

TEST(CutRun, BadBladesAreRefusedAndChangeNothing) {
  Simulation s(scene_with(box_body("box", {0.04, 0.03, 0.03})), open_backend("cpu"));
  s.advance(10);
  const std::uint64_t before = s.hash();
  EXPECT_THROW(s.move_blade("b", {{{0, 0, 0}, {0, 0, 0}}}), Error);
  EXPECT_THROW(s.move_blade("b", {{{0, 0, 0}, {0, NAN, 0}}}), Error);
  EXPECT_THROW(s.cut(std::vector<SweepTriangle>{{Vec3d{0, 0, INFINITY}, {}, {}}}), Error);
  EXPECT_EQ(s.hash(), before);
  EXPECT_FALSE(s.move_blade("b", {{{0.02, -1, -1}, {0.02, -1, 1}}}).changed) << "the first call puts it there";
  EXPECT_TRUE(s.move_blade("b", {{{0.021, 1, -1}, {0.021, 1, 1}}}).changed);
  EXPECT_EQ(s.cut_topology(0)->pieces(), 2);
}

TEST(CutRun, NodesOfACutAreDampedLikeOthers) {
  Body body = box_body("box", {0.04, 0.03, 0.03});
  body.material.damping = 40;
  SimulationOptions options;
  options.dt = 5e-4;  // one that no cut changes
  Simulation s(scene_with(body), open_backend("cpu"), options);
  s.advance(3);
  ASSERT_TRUE(s.cut(wall(0.021)).changed);
  const std::vector<double> w = s.backend().read_reals(s.program().find("node_w"));
  const double k = 0.5 * s.dt() * 40;
  for (const std::int32_t slot : s.model().bodies[0].slot) {
    ASSERT_NEAR(w[4 * static_cast<std::size_t>(slot) + 3], (1 - k) / (1 + k), 1e-7);
  }
}

/// A good state of before the edit belongs to a model that is gone.
TEST(CutRun, ADivergenceAfterAnEditGoesBackToIt) {
  Body body = box_body("box", {0.06, 0.03, 0.03});
  body.velocity = {0.01, 0, 0.02};
  Scene scene = scene_with(body);
  scene.interactive = true;
  SimulationOptions options;
  options.dt = 2e-4;  // given, so that nothing is tried again
  Simulation s(scene, open_backend("cpu"), options);
  s.advance(70);  // between two of the steps at which a state is kept
  ASSERT_TRUE(s.cut(wall(0.031)).changed);
  const std::uint64_t cut = s.hash();
  s.set_forces({{0, 0, {1e6, 0, 0}}});
  s.advance(20);
  ASSERT_TRUE(s.divergence());
  EXPECT_EQ(s.divergence()->last_good_step, 70);
  EXPECT_EQ(s.step(), 70);
  EXPECT_EQ(s.hash(), cut);
  EXPECT_EQ(s.topology_version(), 1);
}

/// Without blades in the scene the step is that of the whole body, which is longer than that of its elements.
TEST(CutRun, AnAutomaticStepFallsToTheElementBound) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    Body body = box_body("box", {0.05, 0.03, 0.03}, element);
    body.velocity = {0.01, -0.02, 0.03};
    const Scene scene = scene_with(body);
    Simulation s(scene, open_backend("cpu:double"));
    const double most = scene.safety * s.model().element_bound;
    ASSERT_GT(s.dt(), 1.001 * most) << "or the cut has nothing to do";
    s.advance(5);
    ASSERT_TRUE(s.cut(wall(0.021)).changed);
    EXPECT_LE(s.dt(), 1.000001 * most);
    s.advance(5);
    EXPECT_LE(s.dt(), 1.000001 * most);
    for (const Vec3d& v : s.velocities(0)) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(v[c], body.velocity[c], 1e-9);
    }
  }
}

TEST(CutRun, NodesOfShapeMatchingKeepTheirVelocity) {
  Body body = box_body("box", {0.06, 0.03, 0.03});
  body.model.type = ModelType::flsm;
  body.model.width = 1;
  body.model.substeps = 3;
  body.velocity = {0.01, -0.02, 0.03};
  SimulationOptions options;
  options.dt = 2e-4;
  Simulation s(scene_with(body), open_backend("cpu:double"), options);
  s.advance(6);
  const auto expect_velocity = [&] {
    for (const Vec3d& v : s.velocities(0)) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(v[c], body.velocity[c], 1e-9);
    }
  };
  expect_velocity();
  ASSERT_TRUE(s.cut(wall(0.031)).changed);
  expect_velocity();
  s.advance(30);
  expect_velocity();
}

TEST(CutRun, BladesThatMoveTogetherMakeOneEdit) {
  const Scene scene = scene_with(box_body("box", {0.06, 0.03, 0.03}));
  Simulation together(scene, open_backend("cpu")), apart(scene, open_backend("cpu"));
  const auto at = [](const char* name, double x, double y) { return BladePose{name, {{{x, y, -1}, {x, y, 1}}}}; };
  for (const double y : {-1.0, 1.0}) {
    const std::vector<BladePose> places{at("a", 0.021, y), at("b", 0.041, y)};
    EXPECT_EQ(together.move_blades(places).changed, y > 0);
    for (const BladePose& p : places) EXPECT_EQ(apart.move_blade(p.blade, p.segment).changed, y > 0);
  }
  EXPECT_EQ(together.topology_version(), 1);
  EXPECT_EQ(apart.topology_version(), 2);
  EXPECT_EQ(together.cut_topology(0)->pieces(), 3);
  expect_same(together.cut_topology(0)->elements(), apart.cut_topology(0)->elements());
  EXPECT_THROW(together.move_blades(std::vector{at("a", 0.03, 1), at("b", NAN, 1)}), Error);
  EXPECT_EQ(together.move_blades(std::vector{at("a", 0.021, 1)}).edges, 0) << "a refused call moves none of them";
}

}  // namespace
}  // namespace pliant
