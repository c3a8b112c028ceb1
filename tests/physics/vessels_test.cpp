// Vessels in bodies of every kind: stress of an affine field, stiffness in parallel with the tissue, momentum, and what a cut
// leaves of them.
#include <algorithm>
#include <array>
#include <span>

#include "cutting/blade/blade.h"
#include "model/pieces.h"
#include "physics/harness.h"
#include "pliant/error.h"

namespace pliant::physics {
namespace {

class VesselPhysics : public OnBackend {};

/// A tree of three branches in a box of 0.75 x 0.5 x 0.5 m.
Vessel tree() {
  Vessel vessel;
  vessel.points = {{0.05, 0.2, 0.22}, {0.4, 0.27, 0.21}, {0.7, 0.11, 0.4}, {0.6, 0.41, 0.07}};
  vessel.segments = {{0, 1}, {1, 2}, {1, 3}};
  vessel.radius = 0.02;
  vessel.wall = 0.004;
  vessel.young = 2e5;
  vessel.density = 1100;
  return vessel;
}

/// Sum over the segments of E A (lambda - 1) / lambda (F a) a^T L: F the deformation gradient, a the direction, L the length.
Matrix3d vessel_moment(const Vessel& vessel, const Matrix3d& f) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& [from, to] : vessel.segments) {
    const Vector3d d =
        eigen(vessel.points[static_cast<std::size_t>(to)]) - eigen(vessel.points[static_cast<std::size_t>(from)]);
    const double length = d.norm();
    const Vector3d a = d / length;
    const double stretch = (f * a).norm();
    sum += vessel.young * vessel.area() * (stretch - 1) / stretch * length * (f * a) * a.transpose();
  }
  return sum;
}

double vessel_length(const Model& model) {
  double sum = 0;
  for (const SpringBatch& b : model.links.springs) {
    for (const double l : b.length) sum += l;
  }
  return sum;
}

double tree_length(const Vessel& vessel) {
  double sum = 0;
  for (const auto& [from, to] : vessel.segments)
    sum += vec::norm(vec::sub(vessel.points[static_cast<std::size_t>(to)], vessel.points[static_cast<std::size_t>(from)]));
  return sum;
}

/// The piece of the elements that hold a point.
std::int32_t piece_at(const Model& model, const std::vector<std::int32_t>& piece, std::int32_t point) {
  const ModelBody& body = model.bodies[0];
  const std::int32_t slot = model.links.points.slots[static_cast<std::size_t>(point)][0];
  for (std::size_t e = 0; e < piece.size(); ++e) {
    const std::span<const std::int32_t> nodes = body.tets.empty() ? std::span<const std::int32_t>(body.hexes[e]) : body.tets[e];
    for (const std::int32_t n : nodes) {
      if (body.slot[static_cast<std::size_t>(n)] == slot) return piece[e];
    }
  }
  return -1;
}

TEST_P(VesselPhysics, AnAffineFieldHasTheStressOfTissueAndVessels) {
  const Box box{{3, 2, 2}, 0.25, 0, 3};
  const Matrix3d h = (Matrix3d() << 0.10, 0.05, -0.02, 0.03, -0.08, 0.04, -0.01, 0.06, 0.07).finished();
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    scene.bodies = {box_body(box, cut, material_young(Law::neo_hookean, 3000, 0.4))};
    scene.bodies[0].vessels = {tree()};
    auto sim = simulate(scene, GetParam());
    write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(h * x); }));
    const Matrix3d f = Matrix3d::Identity() + h;
    const Matrix3d exact = first_piola(f, scene.bodies[0].material) + vessel_moment(tree(), f) / box.volume();
    const Matrix3d p = mean_stress(sim->model(), forces(*sim), box.volume());
    const std::string name = name_of(cut);
    check(name + " mean stress", (p - exact).norm() / exact.norm(), bound(2e-5, 1e-9));
    check_relative(name + " mass", sim->model().bodies[0].mass,
                   1000 * box.volume() + 1100 * tree().area() * tree_length(tree()), 1e-12);
    double slots = 0;
    for (const double m : sim->model().mass) slots += m;
    check_relative(name + " mass of the nodes", slots, sim->model().bodies[0].mass, 1e-9);
  }
}

TEST_P(VesselPhysics, TissueAndVesselPullInParallel) {
  const double edge = 0.02, young = 8000;
  for (const Discretization cut : {Discretization::hex8full, Discretization::hex8_bricks}) {
    Scene scene;
    Body bar = box_body({{8, 2, 2}, edge}, cut, material_young(Law::neo_hookean, young, 0));
    bar.material.damping = 30;
    bar.fixed.push_back({face(0, 0), {true, false, false}});
    bar.fixed.push_back({all_nodes(), {false, true, true}});
    // At the far end all nodes move alike.
    bar.prescribed.push_back({face(0, 8 * edge), {0.02 * 8 * edge, std::nullopt, std::nullopt}, smooth(0.1)});
    Vessel vessel;
    vessel.points = {{0, 1.3 * edge, 0.9 * edge}, {8 * edge, 1.3 * edge, 0.9 * edge}};
    vessel.segments = {{0, 1}};
    vessel.radius = 0.004;
    vessel.young = 2e5;
    bar.vessels = {vessel};
    scene.bodies = {bar};
    auto sim = simulate(scene, GetParam());
    while (sim->time() < 0.6) sim->advance(64);
    double pull = 0;
    const std::vector<Vec3d> f = forces(*sim);
    for (std::size_t s = 0; s < f.size(); ++s) {
      if (sim->model().mass[s] > 0 && sim->model().rest[s][0] < edge / 2) pull += f[s][0];
    }
    const double of_tissue = first_piola(Vector3d(1.02, 1, 1).asDiagonal().toDenseMatrix(), bar.material)(0, 0);
    const double exact = 4 * edge * edge * of_tissue + vessel.young * vessel.area() * 0.02;
    check_relative(std::string(name_of(cut)) + " E A of both", pull, exact, 2e-3);
  }
}

TEST_P(VesselPhysics, ACutPartsItAndKeepsMomentum) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    Scene scene;
    scene.bodies = {box_body({{6, 4, 4}, 0.125, 0, 3}, cut, material_young(Law::neo_hookean, 3000, 0.4))};
    scene.bodies[0].vessels = {tree()};
    scene.bodies[0].angular_velocity = {1, 2, 3};
    scene.cuttable = true;
    scene.least_fill = 0;  // its inertia would come on top
    auto sim = simulate(scene, GetParam());
    sim->advance(50);
    const std::string name = name_of(cut);
    check_relative(name + " length", vessel_length(sim->model()), tree_length(tree()), 1e-12);
    const Momenta before = momenta_of(*sim);
    const double mass = sim->model().bodies[0].mass, at = 0.21;  // across the trunk alone
    const Vec3d a{at, -9, -1}, b{at, 9, -1}, c{at, 0, 20};
    sim->cut(std::array<SweepTriangle, 1>{{{a, b, c}}});
    const Model& model = sim->model();
    std::vector<std::int32_t> piece;
    EXPECT_EQ(pieces_of(model.bodies[0], &piece), 2);
    const double lost = tree_length(tree()) - vessel_length(model);
    EXPECT_GT(lost, 0) << name;
    EXPECT_LT(lost, 1.5 * 0.125) << name << ": no more than a bar of one and a half cells";
    for (const SpringBatch& batch : model.links.springs) {
      for (const auto& [from, to] : batch.points)
        EXPECT_EQ(piece_at(model, piece, from), piece_at(model, piece, to)) << name << ": a bar across the cut";
    }
    check(name + " mass", model.bodies[0].mass / mass - 1, 1e-12);
    const Momenta after = momenta_of(*sim);
    check(name + " momentum", vec::norm(vec::sub(after.linear, before.linear)) / (mass * 0.1), 1e-5);
    sim->advance(200);
    EXPECT_FALSE(sim->divergence().has_value());
  }
}

/// A centre line of many points is as stiff as one of two.
TEST(VesselsBound, ShortBarsDoNotShortenTheStep) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    Scene scene;
    scene.bodies = {box_body({{6, 4, 4}, 0.125, 0, 3}, cut, material_young(Law::neo_hookean, 3000, 0.4))};
    const double without = build_model(scene).element_bound;
    std::array<double, 2> bound{};
    for (const int points : {2, 201}) {
      Vessel vessel = tree();
      vessel.young = 2e6;
      vessel.points.clear();
      vessel.segments.clear();
      for (int i = 0; i < points; ++i) {
        vessel.points.push_back({0.05 + 0.65 * i / (points - 1), 0.2, 0.22});
        if (i > 0) vessel.segments.push_back({i - 1, i});
      }
      scene.bodies[0].vessels = {vessel};
      bound[points > 2 ? 1 : 0] = build_model(scene).element_bound;
    }
    EXPECT_LT(bound[0], without) << name_of(cut) << ": the vessel is stiff enough to matter";
    EXPECT_GT(bound[1] / bound[0], 0.8) << name_of(cut);
  }
}

TEST(VesselsInput, APointOutsideTheElementsIsRefused) {
  Scene scene;
  scene.bodies = {box_body({{3, 2, 2}, 0.25, 0, 3}, Discretization::tet4, material_young(Law::neo_hookean, 3000, 0.4))};
  scene.bodies[0].vessels = {tree()};
  scene.bodies[0].vessels[0].points[2][2] = 0.6;
  scene.bodies[0].vessels[0].pointer = "/bodies/0/vessels/0";
  try {
    static_cast<void>(build_model(scene));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/bodies/0/vessels/0: got point 2 at [0.7, 0.11, 0.6] m, outside the elements"),
              std::string::npos)
        << error.what();
  }
}

PLIANT_ON_BACKENDS(VesselPhysics);

}  // namespace
}  // namespace pliant::physics
