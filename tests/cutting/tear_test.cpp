// Tearing: the physical criterion alone parts the faces of a mesh while it runs.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "cutting/mesh_files.h"
#include "geometry/disjoint_sets.h"
#include "io/save.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/temp_folder.h"
#include "tearing/torn_body.h"

namespace pliant::tear_test {
namespace {

using namespace cut_test;
using test::error_of;

/// A bar of 6 x 2 x 2 cells of 1 cm along x as a file.
std::filesystem::path bar_file(const test::TempFolder& folder) { return tet_box_file(folder, "bar.msh", 6, 2, 2); }

/// Pulled along x to twice its length, with a weak slice in its middle.
Scene bar_scene(const std::filesystem::path& file, double toughness) {
  Body body;
  body.name = "bar";
  body.mesh = file;
  body.element = ElementKind::tet4;
  body.material.set_moduli(Law::neo_hookean, Moduli::from_lame(2000, 1000));
  body.material.damping = 20;
  Inclusion weak{{Selection::Kind::box, {0.02, -1, -1}, {0.03, 1, 1}, 0, {}, ""}, body.material};
  weak.material.toughness = toughness;
  body.inclusions.push_back(weak);
  hold(body, {0, 0, 0}, {-1, 0, 0});
  pull(body, {0.06, 0, 0}, {1, 0, 0}, {0.06, 0, 0}, 0.3);
  return scene_with(body);
}

struct Tear : ::testing::Test {
  test::TempFolder folder;
  std::filesystem::path file = bar_file(folder);
};

std::int32_t pieces_of(const Simulation& s) {
  const ModelBody& body = s.model().bodies[0];
  return figures_of(ElementMesh{body.rest, body.tets, {}, std::vector<double>(body.tets.size(), 1.0)}).pieces;
}

TEST_F(Tear, ABarPartsInItsWeakSliceAndNowhereElse) {
  Simulation s(bar_scene(file, 1500), open_backend("cpu"));
  const double mass = mass_of(s), volume = signed_volume({s.model().surface.rest, s.model().surface.triangles});
  while (s.time() < 0.4 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GT(s.topology_version(), 0);
  EXPECT_GE(pieces_of(s), 2);
  EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
  const ModelSurface& surface = s.model().surface;
  EXPECT_EQ(singular_edges(surface.triangles), 0);
  EXPECT_NEAR(signed_volume({surface.rest, surface.triangles}) / volume, 1, 1e-12);
  std::size_t cut = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.triangle_cut[t] == 0) continue;
    ++cut;
    for (const std::int32_t v : surface.triangles[t]) {
      EXPECT_GE(surface.rest[v][0], 0.02 - 1e-9);
      EXPECT_LE(surface.rest[v][0], 0.03 + 1e-9);
    }
  }
  EXPECT_GE(cut, 16U);
  // The held part has come back to rest, the pulled one has followed.
  const auto u = s.displacements(0);
  EXPECT_NEAR(u[0][0], 0, 1e-9);
  EXPECT_LT(std::abs(u[1][0]), 0.003);
}

/// Numbers of tetrahedra that whole faces connect.
std::vector<int> piece_sizes(const BodyMesh& whole, const std::vector<TetFace>& faces) {
  const auto neighbors = element_neighbors(whole.tets);
  DisjointSets sets(whole.tets.size());
  for (std::size_t t = 0; t < whole.tets.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      const TetFace here{static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)}, there = neighbors[t][f];
      const bool broken = std::any_of(faces.begin(), faces.end(), [&](const TetFace& b) { return b == here || b == there; });
      if (there.tet >= 0 && !broken) sets.join(here.tet, there.tet);
    }
  }
  std::map<std::int32_t, int> size;
  for (std::size_t t = 0; t < whole.tets.size(); ++t)
    ++size[static_cast<std::int32_t>(sets.find(static_cast<std::int32_t>(t)))];
  std::vector<int> out;
  for (const auto& [set, n] : size) out.push_back(n);
  return out;
}

/// Random displacements of every node, large enough to tear the whole bar in many places.
TEST_F(Tear, NoTearCutsOffACrumb) {
  Scene scene = bar_scene(file, 1500);
  const auto whole = std::make_shared<const BodyMesh>(make_body_mesh(scene.bodies[0]));
  Material weak = scene.bodies[0].material;
  weak.toughness = 400;
  const TornBody body(whole, std::vector<Material>(whole->tets.size(), weak));
  std::mt19937 random(11);
  std::size_t broken = 0, parted = 0;
  for (int trial = 0; trial < 600; ++trial) {
    std::vector<Vec3d> x = whole->nodes;
    for (Vec3d& p : x) {
      for (double& c : p) c += 0.006 * (static_cast<double>(random()) / 4294967295.0 - 0.5);
    }
    const auto faces = body.breaking_faces(x).faces;
    const std::vector<int> sizes = piece_sizes(*whole, faces);
    EXPECT_GE(*std::min_element(sizes.begin(), sizes.end()), 6) << "trial " << trial;
    broken += faces.size();
    parted += sizes.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(broken, 6000U);
  EXPECT_GT(parted, 5U) << "larger pieces do come off";
}

TEST_F(Tear, BelowItsToughnessItHolds) {
  Simulation s(bar_scene(file, 20000), open_backend("cpu"));
  while (s.time() < 0.4) s.advance(64);
  EXPECT_EQ(s.topology_version(), 0);
  Scene without = bar_scene(file, 20000);
  without.bodies[0].inclusions[0].material.toughness = 0;
  SimulationOptions same;
  same.dt = s.dt();
  Simulation a(bar_scene(file, 20000), open_backend("cpu"), same), b(without, open_backend("cpu"), same);
  a.advance(200);
  b.advance(200);
  EXPECT_EQ(a.hash(), b.hash()) << "looking at the stress changes the run";
}

/// Faces of tetrahedra with all corners at `at` on an axis.
std::vector<TetFace> faces_in_plane(const BodyMesh& whole, std::size_t axis, double at) {
  std::vector<TetFace> faces;
  for (std::size_t t = 0; t < whole.tets.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      const auto& corners = kTetFaces[f];
      const bool all = std::all_of(corners.begin(), corners.end(), [&](int a) {
        return std::fabs(whole.nodes[whole.tets[t][static_cast<std::size_t>(a)]][axis] - at) < 1e-9;
      });
      if (all) faces.push_back({static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)});
    }
  }
  return faces;
}

/// A node comes from the one that its tetrahedra had at that corner before: also one that tears for the second time.
TEST_F(Tear, EveryCornerComesFromTheNodeItHad) {
  const auto whole = std::make_shared<const BodyMesh>(make_body_mesh(bar_scene(file, 1500).bodies[0]));
  TornBody body(whole, std::vector<Material>(whole->tets.size()));
  std::size_t nodes = whole->nodes.size();
  const std::pair<std::size_t, double> planes[]{{0, 0.03}, {1, 0.01}, {2, 0.01}};
  for (const auto& [axis, at] : planes) {
    const auto before = body.solid().tets;
    const std::vector<std::int32_t> from = body.tear(faces_in_plane(*whole, axis, at));
    const BodyMesh& now = body.solid();
    ASSERT_EQ(from.size(), now.nodes.size());
    EXPECT_GT(now.nodes.size(), nodes);
    nodes = now.nodes.size();
    for (std::size_t t = 0; t < before.size(); ++t) {
      for (std::size_t a = 0; a < 4; ++a) ASSERT_EQ(from[now.tets[t][a]], before[t][a]) << "tetrahedron " << t;
    }
  }
  EXPECT_EQ(
      figures_of(ElementMesh{body.solid().nodes, body.solid().tets, {}, std::vector<double>(whole->tets.size(), 1.0)}).pieces,
      8);
}

/// The slice from 2 to 3 cm is stretched five times, and what is left and right of it by so much.
std::vector<Vec3d> stretched_slice(const BodyMesh& solid, double left, double right) {
  std::vector<Vec3d> x = solid.nodes;
  for (Vec3d& p : x) p[0] = p[0] < 0.021 ? 0.02 + left * (p[0] - 0.02) : 0.07 + right * (p[0] - 0.03);
  return x;
}

/// There are faces, and each has a corner at that x.
void expect_faces_at(const BodyMesh& solid, const std::vector<TetFace>& faces, double place) {
  EXPECT_FALSE(faces.empty());
  for (const TetFace& face : faces) {
    std::size_t at = 0;
    for (const int k : kTetFaces[face.face]) at += std::fabs(solid.nodes[solid.tets[face.tet][k]][0] - place) < 1e-9 ? 1 : 0;
    EXPECT_GT(at, 0) << "tetrahedron " << face.tet << " face " << int{face.face};
  }
}

TEST_F(Tear, AStretchedEdgePartsAtTheEndThatIsPulledMore) {
  const Scene scene = bar_scene(file, 1500);
  const auto whole = std::make_shared<const BodyMesh>(make_body_mesh(scene.bodies[0]));
  const TornBody body(whole, std::vector<Material>(whole->tets.size(), scene.bodies[0].material));
  EXPECT_TRUE(body.breaking_faces(stretched_slice(*whole, 1, 1)).faces.empty());
  EXPECT_TRUE(body.breaking_faces(stretched_slice(*whole, 1, 1), 1.3).faces.empty()) << "whole tissue stands four times that";
  for (const bool left : {true, false}) {
    const auto found = body.breaking_faces(stretched_slice(*whole, left ? 4 : 0.5, left ? 0.5 : 4), 1.2);
    EXPECT_GT(found.edges, 0);
    expect_faces_at(*whole, found.faces, left ? 0.02 : 0.03);
  }
}

TEST_F(Tear, AnEdgeThatIsFreeAtOneEndPartsAtTheOtherAtTwiceTheStretch) {
  const Scene scene = bar_scene(file, 1500);
  const auto whole = std::make_shared<const BodyMesh>(make_body_mesh(scene.bodies[0]));
  TornBody body(whole, std::vector<Material>(whole->tets.size(), scene.bodies[0].material));
  body.tear(faces_in_plane(*whole, 0, 0.02));
  const std::vector<Vec3d> x = stretched_slice(body.solid(), 1, 1);
  EXPECT_TRUE(body.breaking_faces(x, 3).faces.empty()) << "it has time to spring back";
  const auto found = body.breaking_faces(x, 2.4);
  expect_faces_at(body.solid(), found.faces, 0.03);
  // The long edges no longer hold to what is behind them: a node of each has become two.
  const std::size_t nodes = body.solid().nodes.size();
  body.tear(found.faces);
  EXPECT_GE(body.solid().nodes.size(), nodes + static_cast<std::size_t>(found.edges));
}

TEST_F(Tear, IntegrityLowersWhatItBears) {
  Scene scene = bar_scene(file, 6000);
  scene.bodies[0].inclusions[0].material.integrity = 0.25;
  Simulation s(scene, open_backend("cpu"));
  while (s.time() < 0.35) s.advance(64);
  EXPECT_GT(s.topology_version(), 0);
}

/// What a node that tears gives to the others would do work on them.
TEST_F(Tear, LoadsStayWhereTheyWere) {
  Scene scene = bar_scene(file, 1500);
  Force force;
  force.where = {Selection::Kind::box, {-1, -1, -1}, {1, 1, 1}, 0, {}, ""};
  force.force = {0, 0, 1e-3};
  scene.bodies[0].forces.push_back(force);
  Simulation s(scene, open_backend("cpu"));
  const auto by_place = [&] {
    std::map<Vec3d, double> sum;
    std::vector<double> of_slot(static_cast<std::size_t>(s.model().slots));
    for (const NodeForce& f : s.model().forces) of_slot[static_cast<std::size_t>(f.slot)] += f.force[2];
    const ModelBody& body = s.model().bodies[0];
    for (std::size_t n = 0; n < body.rest.size(); ++n) sum[body.rest[n]] += of_slot[static_cast<std::size_t>(body.slot[n])];
    return sum;
  };
  const std::map<Vec3d, double> before = by_place();
  while (s.time() < 0.4 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence());
  EXPECT_GT(s.topology_version(), 0);
  const std::map<Vec3d, double> after = by_place();
  ASSERT_EQ(after.size(), before.size());
  for (const auto& [place, sum] : before) EXPECT_NEAR(after.at(place) / sum, 1, 1e-12);
}

TEST_F(Tear, MomentumIsKeptWhereItTears) {
  Scene scene = bar_scene(file, 1500);
  Body& body = scene.bodies[0];
  body.fixed.clear();
  body.prescribed.clear();
  body.angular_velocity = {0, 0, 90};  // torn by its own spin
  body.material.damping = 0;
  body.inclusions[0].material.damping = 0;
  body.velocity = {0.3, -0.2, 0.1};
  Simulation s(scene, open_backend("cpu:double"));
  const Vec3d before = momentum_of(s);
  for (int k = 0; k < 40; ++k) s.advance(16);
  ASSERT_FALSE(s.divergence());
  EXPECT_GT(s.topology_version(), 0);
  const Vec3d after = momentum_of(s);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-9 * mass_of(s));
}

TEST_F(Tear, AResumedRunAndTheOtherBackendHaveTheSameBits) {
  const Scene scene = bar_scene(file, 1500);
  SimulationOptions options;
  options.dt = 4e-4;
  Simulation whole(scene, open_backend("cpu"), options);
  while (whole.topology_version() == 0 && whole.step() < 2000) whole.advance(16);
  ASSERT_GT(whole.topology_version(), 0);
  whole.advance(5);
  const Checkpoint saved = take_checkpoint(whole);
  whole.advance(200);
  Simulation resumed(scene, open_backend("cpu"), options);
  restore_checkpoint(resumed, saved, "saved");
  resumed.advance(200);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(whole.surface_positions(), resumed.surface_positions());
  if (!testing::has_opencl()) return;
  Simulation device(scene, open_backend("opencl:0"), options);
  device.advance(whole.step());
  EXPECT_EQ(whole.hash(), device.hash());
}

/// A bar whose stress breaks nothing, pulled by so much [m].
Scene tough_bar(const std::filesystem::path& file, double break_stretch, double by) {
  Scene scene = bar_scene(file, 1e9);
  scene.bodies[0].prescribed[0].displacement = {by, 0, 0};
  scene.break_stretch = break_stretch;
  return scene;
}

TEST_F(Tear, WhatIsStretchedTooFarPartsWhateverItsToughness) {
  Simulation s(tough_bar(file, 1.2, 0.4), open_backend("cpu"));
  const double mass = mass_of(s);
  while (s.time() < 0.4 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GT(s.state().opened, 0);
  EXPECT_FALSE(s.state().tears.empty());
  EXPECT_GE(pieces_of(s), 2);
  EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
  EXPECT_EQ(singular_edges(s.model().surface.triangles), 0);
  // Whole tissue stands four times the limit: 1.2 does not open what is stretched 2.7 times.
  for (const Scene& scene : {tough_bar(file, 0, 0.4), tough_bar(file, 1.2, 0.1)}) {
    Simulation other(scene, open_backend("cpu"));
    while (other.time() < 0.4 && !other.divergence()) other.advance(16);
    EXPECT_EQ(other.state().opened, 0);
    EXPECT_EQ(other.topology_version(), 0);
  }
}

/// Half of the slice is weak and tears; the other half is then stretched beside that tear.
Scene notched_bar(const std::filesystem::path& file, double break_stretch) {
  Scene scene = bar_scene(file, 1500);
  scene.bodies[0].inclusions[0].where.b = {0.03, 1, 0.01};
  scene.break_stretch = break_stretch;
  return scene;
}

TEST_F(Tear, BesideATearItPartsSooner) {
  for (const double limit : {0.0, 2.0}) {
    Simulation s(notched_bar(file, limit), open_backend("cpu"));
    while (s.time() < 0.4 && !s.divergence()) s.advance(16);
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    EXPECT_GT(s.topology_version(), 0);
    EXPECT_EQ(s.state().opened > 0, limit > 0);
    EXPECT_EQ(pieces_of(s), limit > 0 ? 2 : 1) << s.state().opened << " edges parted";
  }
}

TEST_F(Tear, StretchedEdgesPartAlikeAfterACheckpointAndOnTheOtherBackend) {
  const Scene scene = notched_bar(file, 2);
  SimulationOptions options;
  options.dt = 4e-4;
  Simulation whole(scene, open_backend("cpu"), options);
  while (whole.state().opened == 0 && whole.step() < 2000) whole.advance(16);
  ASSERT_GT(whole.state().opened, 0);
  whole.advance(5);
  const Checkpoint saved = take_checkpoint(whole);
  whole.advance(200);
  Simulation resumed(scene, open_backend("cpu"), options);
  restore_checkpoint(resumed, saved, "saved");
  resumed.advance(200);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
  if (!testing::has_opencl()) return;
  Simulation device(scene, open_backend("opencl:0"), options);
  device.advance(whole.step());
  EXPECT_EQ(whole.hash(), device.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(device.state()));
}

TEST_F(Tear, WhatCannotTearIsRefused) {
  Scene scene = bar_scene(file, 1500);
  scene.relaxation.enabled = true;
  EXPECT_NE(error_of([&] { Simulation(scene, open_backend("cpu")); }).find("relaxation"), std::string::npos);
  Simulation tears(bar_scene(file, 1500), open_backend("cpu"));
  EXPECT_NE(error_of([&] { tears.cut(wall(0.03)); }).find("toughness"), std::string::npos);
  Scene lattice = scene_with(box_body("box", {0.04, 0.03, 0.03}, ElementKind::tet4));
  lattice.bodies[0].material.toughness = 100;
  EXPECT_NE(error_of([&] { Simulation(lattice, open_backend("cpu")); }).find("volume meshes"), std::string::npos);
  const auto load = [](const std::string& material, const std::string& more) {
    return error_of([&] {
      parse_scene(R"({"format": "pliant-scene/1", "bodies": [{)" + more + R"(, "material": {"young": 1, "poisson": 0.3, )" +
                      material + "}}]}",
                  "s.json");
    });
  };
  const std::string surface = R"("surface": "a.obj", "lattice": {"spacing": 1})", mesh = R"("mesh": "a.msh")";
  EXPECT_NE(load(R"("toughness": 5)", surface).find("/bodies/0/material/toughness"), std::string::npos);
  EXPECT_EQ(load(R"("toughness": 5)", mesh), "");
  EXPECT_NE(load(R"("toughness": 5, "integrity": 1.5)", mesh).find("integrity"), std::string::npos);
  EXPECT_NE(load(R"("integrity": 0.5)", mesh).find("toughness"), std::string::npos);
  EXPECT_NE(load(R"("toughness": -1)", mesh).find("toughness"), std::string::npos);
}

}  // namespace
}  // namespace pliant::tear_test
