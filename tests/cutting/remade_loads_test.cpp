// Loads, holds and networks of bodies whose elements blades divide or remove.
#include <map>

#include "cutting/remade_scenes.h"
#include "simulation/measure/energies_now.h"

namespace pliant::remade_test {
namespace {

Selection beyond(const Vec3d& point, const Vec3d& normal) { return {Selection::Kind::plane, point, normal, 0, {}, ""}; }

/// The force on each place at rest [N].
std::map<Vec3d, Vec3d> forces_of(const Simulation& s) {
  std::map<Vec3d, Vec3d> out;
  for (const auto& force : s.model().forces) {
    Vec3d& sum = out[s.model().rest[static_cast<std::size_t>(force.slot)]];
    sum = vec::add(sum, force.force);
  }
  return out;
}

/// Cuts lengthwise, through the face that is held and the one that is pulled.
TEST_F(Remade, DividedFacesStayHeldAndLoaded) {
  for (const bool listed : {false, true}) {
    Scene scene = block(BladeMethod::decomposition);
    scene.bodies[0].forces.push_back({beyond({0.06, 0, 0}, {1, 0, 0}), {0.05, 0.02, 0}, {}});
    if (listed) {
      const BodyMesh mesh = make_body_mesh(scene.bodies[0]);
      Selection& held = scene.bodies[0].fixed[0].where;
      held = {Selection::Kind::nodes, {}, {}, 0, {}, ""};
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        if (mesh.nodes[n][0] < 1e-9) held.nodes.push_back(static_cast<std::int64_t>(n));
      }
    }
    Simulation s(scene, open_backend("cpu"));
    s.advance(64);
    const std::map<Vec3d, Vec3d> forces = forces_of(s);
    ASSERT_TRUE(s.cut(plane_cut({0.03, 0.0232, 0.02}, {0, 1, 0.1})).changed);
    const std::map<Vec3d, Vec3d> now = forces_of(s);
    ASSERT_EQ(forces.size(), now.size()) << "forces stay with the nodes that had them";
    for (const auto& [place, force] : forces) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(now.at(place)[c], force[c], 1e-15);
    }
    std::vector<char> held(s.model().mass.size(), 0);
    for (const Constraint& c : s.model().constraints) held[static_cast<std::size_t>(c.slot)] = c.axes == 7;
    const ModelBody& body = s.model().bodies[0];
    std::int64_t new_ones = 0;
    for (const EdgeNode& n : body.edge_nodes) new_ones += body.rest[static_cast<std::size_t>(n.node)][0] < 1e-9;
    EXPECT_GT(new_ones, 8) << "the held face is divided";
    for (std::size_t n = 0; n < body.rest.size(); ++n)
      EXPECT_EQ(held[static_cast<std::size_t>(body.slot[n])] != 0, body.rest[n][0] < 1e-9) << n;
    s.advance(2000);
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  }
}

/// What lies between a node that is moved and a free one is free, also within the selection: it would jump to its target.
TEST_F(Remade, NewNodesBesideMovedOnesDoNotJump) {
  Scene scene = block(BladeMethod::decomposition);
  pull(scene.bodies[0], {0.0485, 0, 0}, {1, 0, 0}, {0.02, 0, 0}, 0.1);  // nodes at 0.05 and 0.06 m
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.3) s.advance(16);
  ASSERT_TRUE(s.cut(wall(0.0492 + 0.0195)).changed);
  const ModelBody& body = s.model().bodies[0];
  std::vector<char> held(s.model().mass.size(), 0);
  for (const Constraint& c : s.model().constraints) held[static_cast<std::size_t>(c.slot)] = 1;
  std::int64_t within = 0;
  for (const EdgeNode& n : body.edge_nodes) {
    const double x = body.rest[static_cast<std::size_t>(n.node)][0];
    within += x > 0.0485 && x < 0.05 - 1e-9;
    EXPECT_EQ(held[static_cast<std::size_t>(body.slot[static_cast<std::size_t>(n.node)])] != 0, x > 0.05 - 1e-9);
  }
  EXPECT_GT(within, 8);
  s.advance(1000);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
}

/// A loaded node whose elements all go takes its part of the force along; the others keep theirs.
TEST_F(Remade, NodesWithoutElementsHaveNoForce) {
  Scene scene = block(BladeMethod::removal);
  scene.bodies[0].forces.push_back({beyond({0.06, 0, 0}, {1, 0, 0}), {0.05, 0, 0}, {}});
  Simulation s(scene, open_backend("cpu"));
  s.advance(16);
  const std::map<Vec3d, Vec3d> forces = forces_of(s);
  for (int k = 0; k <= 4; ++k) {
    const double y = 0.042 - 0.001 * k;
    s.move_blades(std::vector<BladePose>{{"corner", {{{0.0595, y, -0.01}, {0.0595, y, 0.05}}}}});
  }
  const std::map<Vec3d, Vec3d> now = forces_of(s);
  EXPECT_LT(now.size(), forces.size());
  for (const auto& [place, force] : now) EXPECT_EQ(force, forces.at(place));
  s.advance(1000);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_TRUE(std::isfinite(s.state().remade.energy));
}

/// What a pressure or a membrane acts on may go altogether.
TEST_F(Remade, RemovedSurfacesTakeTheirLoadsAlong) {
  Scene scene = block(BladeMethod::removal);
  scene.bodies[0].pressures.push_back({beyond({0.0595, 0, 0}, {1, 0, 0}), 20, {}});
  scene.bodies[0].membrane.emplace();
  scene.bodies[0].membrane->thickness = 1e-4;
  scene.bodies[0].membrane->young = 2e4;
  Simulation s(scene, open_backend("cpu"));
  s.advance(16);
  ASSERT_FALSE(s.model().pressures.empty());
  for (const double at : {0.055, 0.045, 0.035, 0.025, 0.015, 0.005}) {
    ASSERT_TRUE(s.cut(wall(at)).changed);
    EXPECT_TRUE(s.model().pressures.empty()) << "the last layer of cells has gone";
    s.advance(50);
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  }
  EXPECT_EQ(s.model().bodies[0].elements(), 0);
}

Scene network(const Remade& test) {
  Scene scene = test.block(BladeMethod::removal);
  Body& body = scene.bodies[0];
  body.model.type = ModelType::mass_spring;
  body.material.damping = 0;
  return scene;
}

/// Springs at the border of what is gone are shares of what they were, as those of a cut are, and the step stays.
TEST_F(Remade, SpringsBesideRemovedElementsAreShares) {
  Scene scene = network(*this);
  scene.bodies[0].model.spring.stiffness = 2;
  scene.bodies[0].model.spring.damping = 0.001;
  Simulation s(scene, open_backend("cpu"));
  const double step = s.dt();
  ASSERT_TRUE(s.cut(wall(0.033)).changed);
  ASSERT_EQ(s.model().links.springs.size(), 1U);
  const std::vector<double>& damper = s.model().links.springs[0].damper;
  EXPECT_NEAR(*std::max_element(damper.begin(), damper.end()), 0.001, 1e-12);
  EXPECT_LT(*std::min_element(damper.begin(), damper.end()), 0.0006);
  EXPECT_GE(s.dt(), 0.999 * step);
}

/// Waves as short as the mesh: the square of one velocity is not what the integrator keeps.
TEST_F(Remade, RemovalInVibratingNetworksMakesNoEnergy) {
  Scene scene = network(*this);
  Simulation s(scene, open_backend("cpu"));
  std::mt19937 dice(8);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  std::vector<Vec3d> v(s.displacements(0).size());
  for (Vec3d& x : v) x = {any(dice), any(dice), any(dice)};
  s.set_nodes(0, s.displacements(0), v);
  for (int k = 0; k < 5; ++k) {
    s.advance(40);
    s.watch_energy();
    ASSERT_TRUE(s.cut(wall(0.055 - 0.01 * k)).changed);
    s.watch_energy();
  }
  s.advance(200);
  s.watch_energy();
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_LT(s.report().energy.share().value(), 0.002);
}

}  // namespace
}  // namespace pliant::remade_test
