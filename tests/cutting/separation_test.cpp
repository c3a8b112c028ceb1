// Blades whose method is separation: running bodies part along the faces of their elements, and no element is added.
#include "cutting/separation_scenes.h"

namespace pliant::separation_test {
namespace {

TEST_F(Separation, ABlockIsCutThroughWithoutNewElements) {
  Simulation s(block_cut_through(), open_backend("cpu"));
  const std::int64_t elements = s.model().bodies[0].elements();
  const double mass = mass_of(s), volume = volume_of(s);
  EXPECT_EQ(elements, 6 * 4 * 4 * 6);
  std::int64_t edits = 0;
  while (s.time() < 0.22 && !s.divergence()) {
    const std::int64_t before = s.topology_version();
    s.advance(s.next_batch(16));
    if (s.topology_version() == before) continue;
    ++edits;
    expect_kept(s, elements, mass, volume);
  }
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GE(edits, 4);
  EXPECT_EQ(pieces_of(s.model().bodies[0]), 2);
  EXPECT_TRUE(s.state().cuts.empty());
  EXPECT_GT(opened_faces(s), 16);
  // Each opened face is two triangles of the cut, near the sweep.
  const ModelSurface& surface = s.model().surface;
  std::int64_t cut = 0;
  double distance = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.triangle_cut[t] == 0) continue;
    ++cut;
    for (const std::int32_t v : surface.triangles[t]) {
      const Vec3d& p = surface.rest[static_cast<std::size_t>(v)];
      distance += std::abs(p[0] - 0.033 - 0.3 * (p[1] - 0.02)) / std::hypot(1, 0.3) / 3;
    }
  }
  EXPECT_EQ(cut, 2 * opened_faces(s));
  EXPECT_LT(distance / static_cast<double>(cut), 0.004) << "it follows the sweep as faces allow: cells are 1 cm wide";
}

TEST_F(Separation, AnUnloadedBodyOpensAsItsMeshAtRestDoes) {
  std::mt19937 dice(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 10; ++k) {
    const std::vector<SweepTriangle> sweep =
        plane_cut({0.03 + 0.01 * any(dice), 0.02, 0.02}, {1, 0.6 * any(dice), 0.6 * any(dice)}, 1);
    Simulation s(block(), open_backend("cpu"));
    const ElementMesh whole = plain_mesh(make_body_mesh(s.scene().bodies[0]));
    SeparationOptions options;
    options.remesh = false;
    const MethodResult rest = separate_crossed(whole, sweep, options);
    const CutReport report = s.cut(sweep);
    EXPECT_EQ(report.edges, rest.crossed);
    EXPECT_EQ(s.model().bodies[0].tets, rest.mesh.tets) << "cut " << k;
    EXPECT_EQ(pieces_of(s.model().bodies[0]), 2);
  }
}

TEST_F(Separation, ABladeThatMovesOpensWhatTheWholeSweepOpens) {
  Simulation moved(block(), open_backend("cpu")), once(block(), open_backend("cpu"));
  const auto at = [](double y) {
    return std::vector<BladePose>{
        {"scalpel", {{{0.033 + 0.27 * (y - 0.0193), y, -0.01}, {0.033 + 0.27 * (y - 0.0193), y, 0.05}}}}};
  };
  for (int k = 0; k <= 12; ++k) moved.move_blades(at(-0.01 + 0.005 * k));
  once.move_blades(at(-0.01));
  once.move_blades(at(0.05));
  EXPECT_EQ(pieces_of(moved.model().bodies[0]), 2);
  const std::vector<int> a = broken_faces(moved), b = broken_faces(once);
  std::int64_t missing = 0, more = 0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    missing += std::popcount(static_cast<unsigned>(b[t] & ~a[t]));
    more += std::popcount(static_cast<unsigned>(a[t] & ~b[t]));
  }
  EXPECT_EQ(missing, 0);
  EXPECT_LE(more, opened_faces(once) / 10) << "at ends of the cut, where elements hang together by an edge only";
}

TEST_F(Separation, FacesThatWaitBreakAfterACheckpointToo) {
  Simulation whole(block(), open_backend("cpu"));
  const auto go = [](Simulation& s, int from, int to) {
    for (int k = from; k <= to; ++k) {
      const double y = -0.01 + 0.005 * k, x = 0.033 + 0.27 * (y - 0.0193);
      s.move_blades(std::vector<BladePose>{{"scalpel", {{{x, y, -0.01}, {x, y, 0.05}}}}});
    }
  };
  const auto waits = [](const TearRecord& tear) { return tear.faces > tear.broken(); };
  int k = 0;
  while (k < 10 && std::none_of(whole.state().tears.begin(), whole.state().tears.end(), waits)) go(whole, k, k), ++k;
  ASSERT_TRUE(std::any_of(whole.state().tears.begin(), whole.state().tears.end(), waits));
  Simulation resumed(block(), open_backend("cpu"));
  restore_checkpoint(resumed, take_checkpoint(whole), "saved");
  go(whole, k, 12);
  go(resumed, k, 12);
  EXPECT_EQ(broken_faces(whole), broken_faces(resumed));
  EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
  EXPECT_EQ(pieces_of(whole.model().bodies[0]), 2);
}

TEST_F(Separation, MomentumAndMotionGoOn) {
  Scene scene = block();
  scene.bodies[0].fixed.clear();
  scene.gravity = {1, -9.81, 2};
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.05) s.advance(16);
  const Vec3d before = momentum_of(s);
  ASSERT_TRUE(s.cut(wall(0.033, 0.3)).changed);
  const Vec3d after = momentum_of(s);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-9 * vec::norm(before));
}

TEST_F(Separation, BackendsAndAResumedRunAgree) {
  Scene scene = pulled(block_cut_through());
  SimulationOptions options;
  options.dt = 4e-4;
  Simulation whole(scene, open_backend("cpu"), options);
  while (whole.topology_version() < 3 && whole.step() < 2000) whole.advance(16);
  ASSERT_GE(whole.topology_version(), 3);
  whole.advance(5);
  const Checkpoint saved = take_checkpoint(whole);
  whole.advance(300);
  EXPECT_EQ(pieces_of(whole.model().bodies[0]), 2);
  Simulation resumed(scene, open_backend("cpu"), options);
  restore_checkpoint(resumed, saved, "saved");
  EXPECT_EQ(resumed.model().bodies[0].elements(), whole.model().bodies[0].elements());
  resumed.advance(300);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
  // The method is part of the model, also before anything is cut.
  Scene other = scene;
  other.blades[0].method = BladeMethod::virtual_nodes;
  Simulation divides(other, open_backend("cpu"), options), parts(scene, open_backend("cpu"), options);
  const Checkpoint foreign = take_checkpoint(divides);
  EXPECT_NE(error_of([&] { restore_checkpoint(parts, foreign, "saved"); }).find("blades"), std::string::npos);
  if (!testing::has_opencl()) return;
  Simulation device(scene, open_backend("opencl:0"), options);
  device.advance(whole.step());
  EXPECT_EQ(whole.hash(), device.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(device.state()));
}

/// In the gap of a cut, a blade that moves cuts nothing more.
TEST_F(Separation, ABladeInTheGapOpensNothing) {
  for (const double gap : {0.012, 0.02, 0.03}) {
    Scene scene = block();
    pull(scene.bodies[0], {0.06, 0, 0}, {1, 0, 0}, {gap, 0, 0}, 0.2);
    Simulation s(scene, open_backend("cpu"));
    ASSERT_TRUE(s.cut(wall(0.027, 0.3)).changed);
    ASSERT_EQ(pieces_of(s.model().bodies[0]), 2);
    while (s.time() < 0.5 && !s.divergence()) s.advance(16);
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    const std::int64_t faces = opened_faces(s);
    const auto place = [&](double y) {  // in its middle
      const double x = 0.027 + 0.3 * y + 0.5 * gap;
      return std::vector<BladePose>{{"scalpel", {{{x, y, -0.01}, {x, y, 0.05}}}}};
    };
    for (int k = 0; k <= 40; ++k) s.move_blades(place(-0.02 + 0.002 * k));
    EXPECT_EQ(opened_faces(s), faces) << "a gap of " << gap << " m";
  }
}

TEST_F(Separation, RandomStrokesUnderLoadLeaveClosedSurfaces) {
  std::mt19937 dice(17);
  std::uniform_real_distribution<double> any(0, 1);
  std::int64_t edits = 0;
  for (int run = 0; run < 12; ++run) {
    Scene scene = pulled(block(run % 3 == 2 ? ElementKind::tet4anp : ElementKind::tet4));
    scene.gravity = {0, -9.81, 0};
    Simulation s(scene, open_backend("cpu"));
    const std::int64_t elements = s.model().bodies[0].elements();
    const double mass = mass_of(s), volume = volume_of(s);
    for (int stroke = 0; stroke < 10; ++stroke) {
      random_stroke(s, "stroke" + std::to_string(stroke), [&] { return any(dice); });
      expect_kept(s, elements, mass, volume);
    }
    edits += s.topology_version();
  }
  EXPECT_GT(edits, 120);
}

TEST_F(Separation, WhatABladeNotchesTearsFromThere) {
  Scene scene = pulled(block());
  scene.bodies[0].material.toughness = 1800;
  Simulation whole(scene, open_backend("cpu")), notched(scene, open_backend("cpu"));
  const BladeSegment above{{{0.033, -0.01, -0.01}, {0.033, -0.01, 0.05}}},
      middle{{{0.033, 0.021, -0.01}, {0.033, 0.021, 0.05}}};
  ASSERT_TRUE(notched.cut(sweep(above, middle)).changed);
  const std::int64_t faces = opened_faces(notched);
  EXPECT_EQ(pieces_of(notched.model().bodies[0]), 1);
  while (opened_faces(notched) == faces && notched.time() < 0.4 && !notched.divergence()) notched.advance(16);
  ASSERT_FALSE(notched.divergence()) << notched.divergence()->message();
  EXPECT_GT(opened_faces(notched), faces);
  whole.advance(notched.step());
  EXPECT_EQ(opened_faces(whole), 0) << "without a notch it bears the pull of " << notched.time() << " s";
}

TEST_F(Separation, ABladeThatPressesOpensFacesWhereTissueGivesWay) {
  Scene scene = block();
  scene.bodies[0].fixed.clear();
  hold(scene.bodies[0], {0, 0.0001, 0}, {0, -1, 0});
  scene.bodies[0].material.toughness = 4000;
  Blade scalpel =
      separating("scalpel", {{0, 0.033, 0.041, -0.01, 0.033, 0.041, 0.05}, {0.3, 0.033, 0.015, -0.01, 0.033, 0.015, 0.05}});
  scalpel.cuts = BladeCuts::by_force;
  scalpel.edge = 0.0005;
  scene.blades = {scalpel};
  Simulation s(scene, open_backend("cpu"));
  const std::int64_t elements = s.model().bodies[0].elements();
  const double mass = mass_of(s), volume = volume_of(s);
  while (s.time() < 0.3 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  expect_kept(s, elements, mass, volume);
  const PressedBlade& pressed = s.state().pressed.at("scalpel");
  EXPECT_GT(pressed.first, 0) << "it pressed before anything gave way";
  EXPECT_GT(pressed.fracture, 0);
  EXPECT_GE(opened_faces(s), 12);
  EXPECT_EQ(pieces_of(s.model().bodies[0]), 1);
}

TEST_F(Separation, WhatCannotPartIsRefused) {
  Scene lattice = scene_with(box_body("box", {0.04, 0.03, 0.03}));
  lattice.blades.push_back(separating("a", {{0, 0, 0, 0, 0, 0, 1}, {1, 1, 0, 0, 1, 0, 1}}));
  EXPECT_NE(error_of([&] { Simulation(lattice, open_backend("cpu")); }).find("parted along its faces"), std::string::npos);
  Scene relaxed = block();
  relaxed.relaxation.enabled = true;
  EXPECT_NE(error_of([&] { Simulation(relaxed, open_backend("cpu")); }).find("relaxation"), std::string::npos);
}

}  // namespace
}  // namespace pliant::separation_test
