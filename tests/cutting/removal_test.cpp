// Blades whose method is removal: the elements of running bodies that they touch go, and their mass and energy with them.
#include "cutting/remade_scenes.h"

namespace pliant::remade_test {
namespace {

constexpr BladeMethod kRemoves = BladeMethod::removal;

/// Bodies of tetrahedra and, as a scene file with such a blade makes it of a lattice, of hexahedra.
Scene body_of(const Remade& test, ElementKind element) {
  Scene scene = test.block(kRemoves, element);
  if (element == ElementKind::tet4) return scene;
  Body body = box_body("block", {0.06, 0.04, 0.04}, element);
  body.plain = true;
  body.material.damping = 20;
  hold(body, {0, 0, 0}, {-1, 0, 0});
  scene.bodies = {body};
  return scene;
}

/// The elements of the whole body that have been removed.
std::vector<std::int32_t> gone(const Simulation& s) {
  std::vector<std::int32_t> out;
  for (const CutRecord& record : s.state().cuts) {
    for (const auto& entry : record.edges) out.push_back(entry.first[0]);
  }
  return out;
}

TEST_F(Remade, WhatABladeTouchesGoesWithItsMass) {
  for (const ElementKind element : {ElementKind::tet4, ElementKind::hex8, ElementKind::hex8full}) {
    Simulation s(body_of(*this, element), open_backend("cpu"));
    const ModelBody whole = s.model().bodies[0];
    const double mass = mass_of(s), step = s.dt();
    double lost = 0;
    for (int k = 0; k <= 12; ++k) {
      const double y = -0.011 + 0.005 * k, x = 0.0332 + 0.3 * (y - 0.02);
      const CutReport report = s.move_blades(std::vector<BladePose>{{"scalpel", {{{x, y, -0.012}, {x, y, 0.053}}}}});
      lost += report.mass_lost;
      EXPECT_EQ(singular_edges(s.model().surface.triangles), 0);
      EXPECT_EQ(report.changed, report.elements < 0);
    }
    EXPECT_EQ(pieces_of(s.model().bodies[0]), 2);
    // By hand: the elements of the whole body that are gone, each of its own volume.
    double volume = 0;
    const std::vector<std::int32_t> numbers = gone(s);
    for (const std::int32_t e : numbers) {
      if (whole.tets.empty()) {
        volume += 1e-6;
        continue;
      }
      std::array<Vec3d, 4> x;
      for (std::size_t a = 0; a < 4; ++a) x[a] = whole.rest[whole.tets[static_cast<std::size_t>(e)][a]];
      volume += vec::dot(vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0])), vec::sub(x[3], x[0])) / 6;
    }
    EXPECT_GT(numbers.size(), 10U);
    EXPECT_EQ(whole.elements() - s.model().bodies[0].elements(), static_cast<std::int64_t>(numbers.size()));
    const double removed = s.scene().bodies[0].material.density * volume;
    EXPECT_NEAR(lost / removed, 1, 1e-12);
    EXPECT_NEAR(s.state().remade.mass / removed, 1, 1e-12);
    EXPECT_NEAR((mass_of(s) + removed) / mass, 1, 1e-12);
    EXPECT_NEAR(volume_of(s) + volume, 0.06 * 0.04 * 0.04, 1e-12);
    EXPECT_EQ(s.dt(), step) << "what is left is not stiffer";
    // It goes through the same gap without touching anything.
    const std::int64_t version = s.topology_version();
    for (int k = 12; k >= 0; --k) {
      const double y = -0.011 + 0.005 * k, x = 0.0332 + 0.3 * (y - 0.02);
      s.move_blades(std::vector<BladePose>{{"scalpel", {{{x, y, -0.012}, {x, y, 0.053}}}}});
    }
    EXPECT_EQ(s.topology_version(), version);
  }
}

/// The bench's method at rest, and a blade that ends inside an element.
TEST_F(Remade, AnUnloadedBodyLosesWhatItsMeshAtRestDoes) {
  std::mt19937 dice(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 10; ++k) {
    const std::vector<SweepTriangle> sweep =
        plane_cut({0.03 + 0.01 * any(dice), 0.02, 0.02}, {1, 0.6 * any(dice), 0.6 * any(dice)}, 0.02 + 0.01 * k);
    Simulation s(block(kRemoves), open_backend("cpu"));
    const MethodResult rest = remove_crossed(plain_mesh(make_body_mesh(s.scene().bodies[0])), sweep);
    EXPECT_EQ(s.cut(sweep).edges, rest.crossed);
    EXPECT_EQ(s.model().bodies[0].tets, rest.mesh.tets) << "cut " << k;
  }
}

/// A bar that hangs has less energy than one at rest: where its end goes, the energy of what is left rises.
TEST_F(Remade, EnergyThatGoesIsWrittenDown) {
  Scene scene = block(kRemoves);
  scene.gravity = {0, -9.81, 0};
  scene.bodies[0].material.damping = 60;
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 2) {  // until it rests: then its energy does not depend on what the square of a velocity is
    s.advance(s.next_batch(16));
    s.watch_energy();
  }
  const auto total = [&] {
    const Model& m = s.model();
    return energies(m, by_slot(m, {s.displacements(0)}), by_slot(m, {s.velocities(0)}), {s.scene().gravity_at(0), s.time()})
        .total();
  };
  const double before = total();
  ASSERT_TRUE(s.cut(wall(0.053)).changed);
  EXPECT_LT(s.state().remade.energy, 0);
  EXPECT_NEAR(s.state().remade.energy, before - total(), 1e-6 * std::abs(before));
  EXPECT_GT(std::abs(s.state().remade.energy), 1e-3 * std::abs(before));
  while (s.time() < 2.2) {
    s.advance(s.next_batch(16));
    s.watch_energy();
  }
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_LT(s.report().energy.share().value(), 1e-3);
}

/// What is left keeps its motion; nodes without elements stay where they are.
TEST_F(Remade, WhatIsLeftMovesOn) {
  Scene scene = block(kRemoves);
  scene.bodies[0].fixed.clear();
  scene.gravity = {1, -9.81, 2};
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.05) s.advance(16);
  const std::vector<Vec3d> u = s.displacements(0), v = s.velocities(0);
  const Vec3d gone_by = u[0];  // it falls as a whole
  ASSERT_TRUE(s.cut(wall(0.025 + gone_by[0])).changed);
  ASSERT_TRUE(s.cut(wall(0.035 + gone_by[0])).changed);
  const std::vector<Vec3d> now = s.displacements(0), speed = s.velocities(0);
  std::vector<char> free(u.size(), 0);
  std::int64_t left = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    EXPECT_EQ(u[n], now[n]);
    free[n] = s.model().mass[static_cast<std::size_t>(s.model().bodies[0].slot[n])] > 0;
    left += free[n];
    EXPECT_EQ(speed[n], free[n] != 0 ? v[n] : Vec3d{}) << n;
  }
  EXPECT_LT(left, static_cast<std::int64_t>(u.size())) << "two layers of cells are gone, and the nodes between them";
  s.advance(64);
  const std::vector<Vec3d> later = s.displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_EQ(later[n] == now[n], free[n] == 0);
}

TEST_F(Remade, ThinnedBodiesResumeAndBackendsAgree) {
  for (const ElementKind element : {ElementKind::tet4, ElementKind::hex8}) {
    Scene scene = pulled(body_of(*this, element));
    scene.blades = cut_through(kRemoves).blades;
    Simulation whole(scene, open_backend("cpu"));
    while (whole.topology_version() < 2 && whole.step() < 4000) whole.advance(16);
    ASSERT_GE(whole.topology_version(), 2);
    whole.advance(5);
    const Checkpoint saved = take_checkpoint(whole);
    whole.advance(300);
    EXPECT_GE(whole.topology_version(), 4);
    Simulation resumed(scene, open_backend("cpu"));
    restore_checkpoint(resumed, saved, "saved");
    resumed.advance(300);
    EXPECT_EQ(whole.hash(), resumed.hash());
    EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
    if (!testing::has_opencl()) continue;
    Simulation device(scene, open_backend("opencl:0"));
    device.advance(whole.step());
    EXPECT_EQ(whole.hash(), device.hash());
    EXPECT_EQ(write_state(whole.state()), write_state(device.state()));
  }
}

TEST_F(Remade, RandomStrokesUnderLoadLeaveClosedSurfacesOfThinnedBodies) {
  std::mt19937 dice(19);
  std::uniform_real_distribution<double> any(0, 1);
  std::int64_t edits = 0;
  for (int run = 0; run < 9; ++run) {
    const std::array<ElementKind, 3> kinds{ElementKind::tet4, ElementKind::hex8, ElementKind::hex8full};
    Scene scene = pulled(body_of(*this, kinds[static_cast<std::size_t>(run % 3)]));
    scene.gravity = {0, -9.81, 0};
    Simulation s(scene, open_backend("cpu"));
    const double mass = mass_of(s);
    for (int stroke = 0; stroke < 8; ++stroke) {
      random_stroke(s, "stroke" + std::to_string(stroke), [&] { return any(dice); });
      EXPECT_NEAR((mass_of(s) + s.state().remade.mass) / mass, 1, 1e-12);
      EXPECT_EQ(singular_edges(s.model().surface.triangles), 0);
      EXPECT_NEAR(mass_of(s), 1000 * volume_of(s), 1e-12);
    }
    edits += s.topology_version();
  }
  EXPECT_GT(edits, 60);
}

/// A probe in tissue that is gone has no numbers, the other one goes on.
TEST_F(Remade, ABodyCanGoAltogether) {
  const Scene scene = block(kRemoves);
  std::vector<SceneProbe> asked;
  for (const double x : {0.011, 0.052}) {
    SceneProbe probe;
    probe.name = "at " + std::to_string(x);
    probe.point = Vec3d{x, 0.0207, 0.0203};
    probe.quantities = {Quantity::position, Quantity::stress};
    asked.push_back(probe);
  }
  Simulation s(scene, open_backend("cpu"));
  const PlacedProbes probes(asked, s.model());
  for (int k = 0; k < 14; ++k) {
    static_cast<void>(s.cut(wall(0.0003 + 0.0045 * k)));
    if (k != 4) continue;
    const std::vector<ProbeState> states = probes.states(s);
    EXPECT_TRUE(std::isnan((*states[0].position)[0]));
    EXPECT_TRUE(std::isnan((*states[0].stress)[5]));
    EXPECT_NEAR((*states[1].position)[0], 0.052, 1e-12);
  }
  EXPECT_EQ(s.model().bodies[0].elements(), 0);
  s.advance(64);
  EXPECT_FALSE(s.divergence());
}

}  // namespace
}  // namespace pliant::remade_test
