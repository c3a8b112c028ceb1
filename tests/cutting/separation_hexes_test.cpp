// Lattices and meshes of hexahedra that blades part along their faces.
#include "cutting/separation_scenes.h"

namespace pliant::separation_test {
namespace {

/// A lattice of 6 x 4 x 4 cells, as a scene file with such a blade makes it.
Scene lattice_scene(ElementKind element) {
  Body body = box_body("block", {0.06, 0.04, 0.04}, element);
  body.plain = true;
  body.material.damping = 20;
  hold(body, {0, 0, 0}, {-1, 0, 0});
  Scene scene = scene_with(body);
  scene.blades.push_back(separating("far", {{0, 5, 5, 5, 5, 5, 6}, {1, 5, 6, 5, 5, 6, 6}}));
  return scene;
}

/// Cells part at their faces alone: a leaning blade leaves a staircase, a blade along a layer of faces that layer.
TEST_F(Separation, ALatticePartsAlongAStaircase) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4}) {
    for (const double lean : {0.0, 0.4}) {
      Simulation s(lattice_scene(element), open_backend("cpu"));
      const std::int64_t elements = s.model().bodies[0].elements();
      const double mass = mass_of(s), volume = volume_of(s);
      EXPECT_NEAR(volume, 0.06 * 0.04 * 0.04, 1e-12);
      for (int k = 0; k <= 12; ++k) {
        const double y = -0.011 + 0.005 * k, x = 0.0312 + lean * (y - 0.02);
        s.move_blades(std::vector<BladePose>{{"scalpel", {{{x, y, -0.012}, {x, y, 0.053}}}}});
        expect_kept(s, elements, mass, volume);
      }
      EXPECT_EQ(pieces_of(s.model().bodies[0]), 2);
      if (element == ElementKind::tet4) continue;
      EXPECT_EQ(s.model().bodies[0].hexes.size(), 96U);
      const std::int64_t opened = opened_faces(s);
      EXPECT_TRUE(lean == 0 ? opened == 16 : opened >= 20) << opened << "; a leaning cut has faces between its steps, too";
    }
  }
}

TEST_F(Separation, RandomStrokesThroughALoadedLatticeLeaveClosedSurfaces) {
  std::mt19937 dice(23);
  std::uniform_real_distribution<double> any(0, 1);
  for (int run = 0; run < 6; ++run) {
    Scene scene = pulled(lattice_scene(run % 2 == 0 ? ElementKind::hex8 : ElementKind::hex8full));
    scene.gravity = {0, -9.81, 0};
    Simulation s(scene, open_backend("cpu"));
    const std::int64_t elements = s.model().bodies[0].elements();
    const double mass = mass_of(s), volume = volume_of(s);
    for (int stroke = 0; stroke < 10; ++stroke) {
      random_stroke(s, "stroke" + std::to_string(stroke), [&] { return any(dice); });
      expect_kept(s, elements, mass, volume);
    }
    EXPECT_GT(s.topology_version(), 5);
  }
}

/// Traces of a blade in hexahedra are part of a checkpoint, too.
TEST_F(Separation, HexahedraResumeAndBackendsAgree) {
  Scene scene = pulled(lattice_scene(ElementKind::hex8));
  scene.blades = block_cut_through().blades;
  SimulationOptions options;
  options.dt = 4e-4;
  Simulation whole(scene, open_backend("cpu"), options);
  while (whole.topology_version() < 3 && whole.step() < 2000) whole.advance(16);
  ASSERT_GE(whole.topology_version(), 3);
  whole.advance(5);
  const Checkpoint saved = take_checkpoint(whole);
  ASSERT_FALSE(whole.state().blades.traces.empty());
  whole.advance(300);
  Simulation resumed(scene, open_backend("cpu"), options);
  restore_checkpoint(resumed, saved, "saved");
  resumed.advance(300);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
  if (!testing::has_opencl()) return;
  Simulation device(scene, open_backend("opencl:0"), options);
  device.advance(whole.step());
  EXPECT_EQ(whole.hash(), device.hash());
}

TEST_F(Separation, ABladeThatPressesMeetsHexahedra) {
  Scene scene = lattice_scene(ElementKind::hex8);
  scene.bodies[0].fixed.clear();
  hold(scene.bodies[0], {0, 0.0001, 0}, {0, -1, 0});
  scene.bodies[0].material.toughness = 4000;
  Blade scalpel =
      separating("scalpel", {{0, 0.033, 0.041, -0.01, 0.033, 0.041, 0.05}, {0.3, 0.033, 0.015, -0.01, 0.033, 0.015, 0.05}});
  scalpel.cuts = BladeCuts::by_force;
  scalpel.edge = 0.0005;
  scene.blades = {scalpel};
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.3 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GT(s.state().pressed.at("scalpel").first, 0) << "it has met the tissue";
  EXPECT_GT(opened_faces(s), 0);
  const Checkpoint saved = take_checkpoint(s);
  Simulation resumed(scene, open_backend("cpu"));
  restore_checkpoint(resumed, saved, "saved");
  s.advance(50);
  resumed.advance(50);
  EXPECT_EQ(s.hash(), resumed.hash());
}

}  // namespace
}  // namespace pliant::separation_test
