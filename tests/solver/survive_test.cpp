// What keeps a run going: inertia for elements that ask for too short a step, motion taken out of those that would turn inside
// out, and tissue that parts where it is stretched too far.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cutting/cut_scenes.h"
#include "geometry/vec.h"
#include "model/elements/each_element.h"
#include "model/elements/least_fill.h"
#include "model/nodes/ballast.h"
#include "pliant/error.h"
#include "simulation/measure/energy.h"
#include "simulation/recovery/ballast_swap.h"
#include "simulation/recovery/calm.h"
#include "solver/loaded.h"
#include "solver/scenes.h"
#include "support/error_of.h"

namespace pliant {
namespace {

using namespace cut_test;

Vec3d momentum(const Loaded& l) {
  Vec3d sum{};
  const std::vector<double> w = l.loaded.w();
  for (std::size_t s = 0; s < l.run.model().mass.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += l.run.model().mass[s] * w[4 * s + c] / l.state.clock.dt;
  }
  return sum;
}

double kinetic(const Loaded& l) {
  double sum = 0;
  const std::vector<double> w = l.loaded.w();
  for (std::size_t s = 0; s < l.run.model().mass.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) sum += 0.5 * l.run.model().mass[s] * std::pow(w[4 * s + c] / l.state.clock.dt, 2);
  }
  return sum;
}

/// Every node has a velocity of its own.
void stir(Loaded& l, double largest) {
  std::vector<double> w = l.loaded.w();
  for (std::size_t s = 0; s < l.run.model().mass.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) w[4 * s + c] = largest * std::sin(1.7 * static_cast<double>(3 * s + c));
  }
  l.loaded.write_w(w);
}

Scene box_scene() {
  Scene scene = scene_with(box_body("box", {0.03, 0.02, 0.02}));
  scene.gravity = {0, 0, -9.81};
  return scene;
}

/// All nodes with x above (`side` 1) or below (-1) this.
Selection beyond(double x, double side) {
  Selection where;
  where.kind = Selection::Kind::plane;
  where.a = {x, 0, 0};
  where.b = {side, 0, 0};
  return where;
}

Scene held(Scene scene) {
  scene.bodies[0].fixed.push_back({beyond(0.001, -1)});
  return scene;
}

TEST(Ballast, HeavierNodesKeepTheirMomentumLighterOnesTheirVelocity) {
  Loaded l(box_scene());
  stir(l, 1e-4);
  const Vec3d before = momentum(l);
  const double energy = kinetic(l);
  const std::int32_t slot = l.run.model().bodies[0].slot[5];
  load_ballast(l.run, {{slot, 3e-3}});
  EXPECT_EQ(l.run.model().own_mass(static_cast<std::size_t>(slot)) + 3e-3, l.run.model().mass[static_cast<std::size_t>(slot)]);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(momentum(l)[c], before[c], 1e-15);
  EXPECT_LT(kinetic(l), energy);
  EXPECT_EQ(l.loaded.u()[4 * static_cast<std::size_t>(slot) + 3], 1 / l.run.model().mass[static_cast<std::size_t>(slot)]);
  const std::vector<double> w = l.loaded.w();
  load_ballast(l.run, {});
  EXPECT_EQ(l.loaded.w(), w);
}

TEST(Ballast, HasNoWeightAndLeavesNoTrace) {
  Loaded l(held(box_scene()));
  const Model first = l.run.model();
  const std::vector<double> u = l.loaded.u(), rest = l.run.forces_now();
  const std::int32_t slot = first.bodies[0].slot.back();
  load_ballast(l.run, {{slot, 0.1}});
  const double up = l.run.forces_now()[4 * static_cast<std::size_t>(slot) + 2];
  EXPECT_NEAR(up, 0.1 * 9.81, 1e-12) << "against what gravity does to it";
  load_ballast(l.run, {});
  EXPECT_EQ(l.run.model().mass, first.mass);
  EXPECT_EQ(l.run.forces_now(), rest);
  EXPECT_EQ(l.loaded.u(), u) << "held nodes have no inverse mass";
}

TEST(Ballast, TheBoundIsBelowTheStableStepAndNotFarBelow) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4}) {
    for (const double pull : {0.0, 0.02}) {
      Scene scene = held(scene_with(box_body("box", {0.03, 0.02, 0.02}, element)));
      Prescribed far;
      far.where = beyond(0.029, 1);
      far.displacement = {pull, 0.3 * pull, 0.0};
      far.curve.kind = Curve::Kind::smooth;
      far.curve.duration = 0.1;
      scene.bodies[0].material.damping = 30;
      scene.bodies[0].prescribed.push_back(far);
      Simulation s(scene, open_backend("cpu:double"));
      s.advance(300);
      const std::vector<double> u = s.backend().read_reals(s.program().find("node_u"));
      const double bound = stiffness_bound(s.model(), nodal_stiffness(s.model(), u)), stable = s.estimate_stable_dt(100);
      SCOPED_TRACE(fmt::format("{} {}: bound {:.4g} s, stable step {:.4g} s", to_string(element), pull, bound, stable));
      EXPECT_LT(bound, 1.05 * stable);  // the estimate errs on the safe side
      EXPECT_GT(bound, 0.4 * stable);
      const double quick = stiffness_bound(s.model(), nodal_stiffness(s.model(), u, {}, true));
      EXPECT_LE(quick, bound);
      EXPECT_GT(quick, 0.8 * bound);
      // Of some nodes alone: what all of their elements add up to.
      std::vector<char> wanted(s.model().mass.size());
      for (std::size_t n = 0; n < wanted.size(); n += 3) wanted[n] = 1;
      const std::vector<double> all = nodal_stiffness(s.model(), u), some = nodal_stiffness(s.model(), u, wanted);
      for (std::size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(some[n], wanted[n] != 0 ? all[n] : 0);
    }
  }
}

TEST(Ballast, WhatIsWantedIsEnoughAndIsGivenBack) {
  const Scene scene = box_scene();
  Model model = build_model(scene);
  const std::vector<double> u(4 * static_cast<std::size_t>(model.slots));
  std::vector<double> k = nodal_stiffness(model, u);
  const double bound = stiffness_bound(model, k);
  EXPECT_TRUE(wanted_ballast(model, k, 0.99 * bound).empty());
  const auto one = static_cast<std::size_t>(model.bodies[0].slot[7]);
  k[one] *= 100;
  const std::vector<NodeInertia> wanted = wanted_ballast(model, k, 0.9 * bound);
  ASSERT_EQ(wanted.size(), 1);
  EXPECT_EQ(wanted[0].slot, static_cast<std::int32_t>(one));
  set_ballast(scene, model, wanted);
  EXPECT_GT(stiffness_bound(model, k), 0.9 * bound);
  EXPECT_EQ(wanted_ballast(model, k, 0.9 * bound).size(), 1) << "it lasts";
  k[one] /= 100;
  EXPECT_TRUE(wanted_ballast(model, k, 0.9 * bound).empty());
}

TEST(Ballast, ADamagedStateIsRefused) {
  Simulation s(box_scene(), open_backend("cpu"));
  const std::int32_t node = s.model().bodies[0].slot[0];
  for (const std::vector<NodeInertia>& bad : {std::vector<NodeInertia>{{-1, 1.0}},
                                              {{s.model().slots, 1.0}},
                                              {{node, -1.0}},
                                              {{node, NAN}},
                                              {{node, 1.0}, {node, 1.0}}}) {
    Snapshot snapshot = s.snapshot();
    snapshot.state.ballast = bad;
    EXPECT_NE(test::error_of([&] { s.restore(snapshot); }).find("damaged"), std::string::npos);
  }
}

/// Also of nodes that shape matching alone moves, all of them or some.
TEST(Calm, KeepsMomentumAndBringsFastMotionDown) {
  for (const ModelType type : {ModelType::tled, ModelType::hybrid, ModelType::flsm}) {
    Scene scene = box_scene();
    scene.bodies[0].model.type = type;
    Loaded l(scene);
    stir(l, 0.1);
    const Vec3d before = momentum(l);
    const double energy = kinetic(l);
    EXPECT_GT(calm(l.run, 0.25).elements, 0);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(momentum(l)[c], before[c], 1e-12 * std::abs(before[c]) + 1e-13);
    EXPECT_LT(kinetic(l), 0.5 * energy);
    Loaded slow(scene);
    stir(slow, 1e-4);
    const std::vector<double> w = slow.loaded.w();
    EXPECT_EQ(calm(slow.run, 0.25).elements, 0);
    EXPECT_EQ(slow.loaded.w(), w);
  }
}

/// The largest increment of a node against another, in edges of a cell of 1 cm.
double relative_motion(const Loaded& l) {
  const std::vector<double> w = l.loaded.w();
  double most = 0;
  for (const std::int32_t a : l.run.model().bodies[0].slot) {
    for (const std::int32_t b : l.run.model().bodies[0].slot) {
      Vec3d d;
      for (std::size_t c = 0; c < 3; ++c)
        d[c] = w[4 * static_cast<std::size_t>(a) + c] - w[4 * static_cast<std::size_t>(b) + c];
      most = std::max(most, vec::norm(d) / 0.01);
    }
  }
  return most;
}

TEST(Calm, AnElementThatIsAloneKeepsAFifth) {
  Loaded l(scene_with(box_body("crumb", {0.01, 0.01, 0.01})));
  ASSERT_EQ(l.run.model().elements(), 1);
  stir(l, 2e-3);
  const Vec3d before = momentum(l);
  ASSERT_GT(relative_motion(l), 0.3);
  const Calmed found = calm(l.run, 0.25);
  EXPECT_EQ(found.elements, 1);
  EXPECT_GT(found.fastest, 0.1);
  EXPECT_LT(relative_motion(l), 0.1001);  // 0.05 from the mean
  EXPECT_GT(relative_motion(l), 0.05);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(momentum(l)[c], before[c], 1e-12 * std::abs(before[c]) + 1e-13);
  Loaded two(scene_with(box_body("box", {0.02, 0.01, 0.01})));
  stir(two, 2e-3);
  EXPECT_EQ(calm(two.run, 0.25).elements, 0) << "what hangs together keeps such motion";
}

TEST(Calm, LooksAtMotionAgainstHeldNodes) {
  Loaded l(held(scene_with(box_body("box", {0.02, 0.01, 0.01}))));
  std::vector<double> w = l.loaded.w();
  for (std::size_t s = 0; s < l.run.model().mass.size(); ++s) {
    if (l.loaded.free()[3 * s]) w[4 * s] = 5e-3;  // all alike, away from those
  }
  l.loaded.write_w(w);
  EXPECT_GT(calm(l.run, 0.25).elements, 0);
  const auto& body = l.run.model().bodies[0];
  for (std::size_t n = 0; n < body.slot.size(); ++n) {
    const double x = body.rest[n][0], moved = l.loaded.w()[4 * static_cast<std::size_t>(body.slot[n])];
    if (x > 0.015) continue;  // its element moves less than what is allowed
    EXPECT_NEAR(moved, x < 0.005 ? 0 : 2.5e-3, 1e-12);
  }
}

/// Half an edge in every step, and no element deforms: nobody looks for another step.
TEST(Calm, PiecesThatFlyAreLeftAlone) {
  Scene scene = scene_with(box_body("box", {0.03, 0.02, 0.02}));
  const double dt = Simulation(scene, open_backend("cpu")).dt();
  scene.bodies[0].velocity = {0.005 / dt, 0, 0};
  SimulationOptions options;
  options.batch_steps = 16;
  Simulation s(scene, open_backend("cpu"), options);
  const double stable = s.stable_dt();
  s.advance(48);  // after 64 the step is looked at in any case
  EXPECT_EQ(s.stable_dt(), stable);
  EXPECT_EQ(s.dt(), dt);
}

/// A box of 4 cm that is pulled by 20 cm, and a blade that stays far away.
Scene pulled(double break_stretch, bool with_blade = true, double by = 0.2) {
  Scene scene = held(scene_with(box_body("box", {0.04, 0.02, 0.02})));
  Prescribed far;
  far.where = beyond(0.039, 1);
  far.displacement = {by, 0.0, 0.0};
  far.curve.kind = Curve::Kind::smooth;
  far.curve.duration = 0.5;
  scene.bodies[0].prescribed.push_back(far);
  scene.bodies[0].material.damping = 20;
  if (with_blade) scene.blades.push_back(blade("far", {{0, 5, 5, 5, 5, 6, 5}, {1, 5, 5, 6, 5, 6, 6}}));
  scene.break_stretch = break_stretch;
  return scene;
}

TEST(Overstretched, PartsInASceneThatIsCut) {
  const double whole = mass_of(Simulation(pulled(1.2), open_backend("cpu")));
  Simulation s(pulled(1.2), open_backend("cpu"));
  while (s.time() < 0.6 && !s.divergence()) s.advance(64);
  EXPECT_FALSE(s.divergence());
  EXPECT_GT(s.state().opened, 0);
  EXPECT_GE(s.cut_topology(0)->pieces(), 2);  // at one end, or at both at once
  EXPECT_NEAR(mass_of(s), whole, 1e-14 * whole);
  // Whole tissue stands four times the limit: 1.2 does not open what is stretched 2.5 times.
  for (const Scene& scene : {pulled(0), pulled(1.2, false), pulled(1.2, true, 0.06)}) {
    Simulation other(scene, open_backend("cpu"));
    while (other.time() < 0.6 && !other.divergence()) other.advance(64);
    EXPECT_EQ(other.state().opened, 0);
  }
}

TEST(Overstretched, PartsSoonerBesideACut) {
  Scene scene = pulled(1.2, true, 0.06);
  scene.blades = {blade("notch", {{0, 0.02, -0.01, -1, 0.02, -0.01, 1}, {0.05, 0.02, 0.008, -1, 0.02, 0.008, 1}})};
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.6 && !s.divergence()) s.advance(64);
  EXPECT_FALSE(s.divergence());
  EXPECT_GT(s.state().opened, 0);
}

/// A hybrid that is too soft for its weight tears into fragments of a few cells. Those of shape matching stretch without end if
/// their law stiffens without end, and nothing takes fast motion out of them: node displacements of 1e34 m within 0.5 s.
TEST(SoftHybrid, FallsApartAndGoesOn) {
  const Scene scene =
      parse_scene(R"({"format": "pliant-scene/1", "break_stretch": 1.8, "gravity": [0, -9.81, 0], "bodies": [{"name": "liver",
      "surface": "meshes/liver.obj", "lattice": {"nodes": 700}, "element": "hex8",
      "material": {"law": "neo-hookean", "young": 2500, "poisson": 0.45, "density": 1050},
      "model": {"type": "hybrid", "ratio": 0.4, "seed": [0, 0, 0], "width": 1},
      "fixed": [{"plane": [[-0.09, 0, 0], [-1, 0, 0]]}],
      "prescribed": [{"plane": [[0.09, 0, 0], [1, 0, 0]], "displacement": [0.1, 0, 0], "curve": "smooth", "duration": 0.5}]}],
    "blades": [{"name": "k", "path": [[0.4, 0.01, -0.2, 0.2, 0.01, 0.2, 0.2], [0.9, 0.02, -0.2, -0.2, 0.02, 0.2, -0.2]]}]})",
                  test::source_dir() + "/scenes/soft_hybrid.json");
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.5 && !s.divergence()) s.advance(16);
  EXPECT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GT(s.state().opened, 100);
  // Fragments fall and spring back: by 1.2 m and a few body lengths at most.
  for (const Vec3d& u : s.displacements(0)) EXPECT_LT(vec::norm(u), 3);
}

TEST(ThinCells, AreAsStiffAndAsInertAsATwentiethOfAFullOneAndAsHeavyAsTheyAre) {
  Scene scene = scene_with(box_body("box", {0.04, 0.02, 0.02}));
  scene.cuttable = true;
  Simulation s(scene, open_backend("cpu"));
  const double mass = mass_of(s);
  s.cut(wall(0.0101));  // leaves a hundredth of a cell on one side
  ASSERT_EQ(s.cut_topology(0)->pieces(), 2);
  std::size_t thin = 0;
  for_each_element(s.model(), [&](const ElementView& e) {
    EXPECT_GE(e.share, scene.least_fill);
    thin += e.share == scene.least_fill ? 1 : 0;
  });
  EXPECT_GE(thin, 4);
  EXPECT_NEAR(mass_of(s), mass, 1e-14);
  EXPECT_GT(s.model().bodies[0].added_mass, 0);
}

double elastic(const Simulation& s) {
  const std::vector<std::vector<Vec3d>> u{s.displacements(0)}, v{s.velocities(0)};
  const Energies e = energies(s.model(), by_slot(s.model(), u), by_slot(s.model(), v), {{}, s.time()});
  return e.strain + e.hourglass;
}

// Copies are deformed like the cell they come from, and share its stiffness, however thin they are.
TEST(ThinCells, CuttingDeformedTissueChangesNoElasticEnergy) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4}) {
    Scene scene = pulled(0);
    scene.bodies[0].element = element;
    Simulation s(scene, open_backend("cpu:double"));
    while (s.time() < 0.1) s.advance(64);
    const double before = elastic(s);
    ASSERT_GT(before, 0);
    // Close to the layers of nodes, wherever these are by now.
    const std::vector<Vec3d> rest = s.model().bodies[0].rest;
    const std::vector<Vec3d> u = s.displacements(0);
    for (const double layer : {0.01, 0.02, 0.03}) {
      double sum = 0, count = 0;
      for (std::size_t n = 0; n < rest.size(); ++n) {
        if (std::abs(rest[n][0] - layer) > 1e-6) continue;
        sum += rest[n][0] + u[n][0];
        ++count;
      }
      s.cut(wall(sum / count + 1e-4));
      EXPECT_NEAR(elastic(s), before, 1e-9 * before) << to_string(element) << " at " << layer;
    }
    EXPECT_GT(s.model().bodies[0].added_mass, 0) << "no copy is thin";
    ASSERT_GE(s.cut_topology(0)->pieces(), 3);
  }
}

TEST(StiffFills, ShareWhatTheWholeCellWas) {
  BodyElements solid;
  const double least = 0.05;
  const auto of = [&](std::vector<double> fill, std::vector<std::int32_t> copy_of) {
    solid.fill = std::move(fill);
    solid.copy_of = std::move(copy_of);
    return stiff_fills(solid, least);
  };
  EXPECT_EQ(of({1, 0.5, 0.01}, {}), (std::vector<double>{1, 0.5, 0.05}));
  EXPECT_EQ(of({0.3, 0.5, 0.7}, {0, 1, 0}), (std::vector<double>{0.3, 0.5, 0.7}));  // nothing is thin
  const std::vector<double> thin = of({0.001, 1, 0.599, 0.4}, {0, 1, 0, 0});
  EXPECT_DOUBLE_EQ(thin[0] + thin[2] + thin[3], 1);
  EXPECT_EQ(thin[0], least);
  EXPECT_GT(thin[2], thin[3]);
  EXPECT_GT(thin[2], 0.56);
  const std::vector<double> skin = of({0.008, 0.002}, {0, 0});  // of a cell that was thin before
  EXPECT_DOUBLE_EQ(skin[0] + skin[1], least);
  EXPECT_DOUBLE_EQ(skin[1], least / 2);
  EXPECT_EQ(of({0.02, 0, 0.03}, {0, 0, 1}), (std::vector<double>{0.05, 0, 0.05}));  // a copy without material is none
}

}  // namespace
}  // namespace pliant
