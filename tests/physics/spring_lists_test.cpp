// Springs between listed nodes of bodies of every kind: their force, a list of the edges against the network of the edges, a
// tendon that bends a beam, and what cuts leave of them.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "cutting/blade/blade.h"
#include "model/pieces.h"
#include "physics/harness.h"

namespace pliant::physics::spring_lists_test {
namespace {

class SpringLists : public OnBackend {};

const std::vector<Discretization>& meshes() {
  static const std::vector<Discretization> all{Discretization::tet4, Discretization::tet4anp, Discretization::hex8,
                                               Discretization::hex8full};
  return all;
}

/// Long springs through a box of 6 x 4 x 4 cells, of the node rows i = 0 and i = 6 and some across, each with its own factor.
SpringList long_springs(bool stretched) {
  SpringList list;
  list.spring.stiffness = 40;
  const auto node = [](int i, int j, int k) { return i + 7 * (j + 5 * k); };
  for (int j = 0; j < 5; ++j) {
    for (int k = 0; k < 5; k += 2) list.nodes.push_back({node(0, j, k), node(6, 4 - j, k)});
    list.nodes.push_back({node(j + 1, 0, j), node(j + 1, 4, 4 - j)});
  }
  for (std::size_t s = 0; s < list.nodes.size(); ++s) {
    list.factor.push_back(0.5 + 0.1 * static_cast<double>(s));
    list.length.push_back(stretched ? 0.3 + 0.01 * static_cast<double>(s) : 0);
  }
  return list;
}

Scene box_scene(Discretization cut, std::vector<SpringList> springs) {
  Scene scene;
  scene.bodies = {box_body({{6, 4, 4}, 0.125, 0, 3}, cut, material_young(Law::neo_hookean, 3000, 0.4))};
  scene.bodies[0].springs = std::move(springs);
  return scene;
}

TEST_P(SpringLists, TheirForceIsThatOfTheLaw) {
  const Matrix3d h = (Matrix3d() << 0.10, 0.05, -0.02, 0.03, -0.08, 0.04, -0.01, 0.06, 0.07).finished();
  for (const Discretization cut : meshes()) {
    std::array<std::vector<Vec3d>, 2> all;
    SpringList list = long_springs(true);
    list.spring.law = SpringLaw::cubic;
    list.spring.lambda1 = 5, list.spring.lambda2 = 20;
    std::vector<Vec3d> rest;
    for (const bool with : {false, true}) {
      const auto sim = simulate(box_scene(cut, with ? std::vector{list} : std::vector<SpringList>()), GetParam());
      write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(h * x); }));
      all[with ? 1 : 0] = sim->residual_forces(0);
      rest = sim->model().bodies[0].rest;
    }
    std::vector<Vector3d> exact(rest.size(), Vector3d::Zero());
    double size = 0;
    for (std::size_t s = 0; s < list.nodes.size(); ++s) {
      const auto& [a, b] = list.nodes[s];
      const Vector3d d = (Matrix3d::Identity() + h) * (eigen(rest[b]) - eigen(rest[a]));
      const double e = (d.norm() - list.length[s]) / list.length[s];
      const Vector3d f = list.factor[s] * (list.spring.lambda1 * e * e * e + list.spring.lambda2 * e) * d.normalized();
      exact[a] += f;
      exact[b] -= f;
      size = std::max(size, f.norm());
    }
    double error = 0;
    for (std::size_t n = 0; n < rest.size(); ++n)
      error = std::max(error, (eigen(all[1][n]) - eigen(all[0][n]) - exact[n]).norm());
    check(std::string(name_of(cut)) + " force over the largest one", error / size, bound(5e-6, 1e-12));
  }
}

/// The same springs, once of the model and once listed.
TEST_P(SpringLists, AListOfTheEdgesMovesAsTheEdges) {
  std::array<std::vector<Vec3d>, 2> moved;
  for (const bool listed : {false, true}) {
    Scene scene;
    Body body = box_body({{5, 2, 2}, 0.02, 0.1, 3}, Discretization::tet4, material_young(Law::neo_hookean, 4000, 0.25));
    body.model.type = ModelType::mass_spring;
    body.model.spring.stiffness = 30;
    body.fixed.push_back({face(0, 0), {true, true, true}});
    if (listed) {
      body.model.edge_springs = false;
      SpringList& list = body.springs.emplace_back();
      list.spring.stiffness = 30;
      std::set<std::array<std::int32_t, 2>> edges;
      for (const auto& t : make_mesh({{5, 2, 2}, 0.02, 0.1, 3}, true).tets) {
        for (int a = 0; a < 4; ++a) {
          for (int b = 0; b < a; ++b) edges.insert({std::min(t[a], t[b]), std::max(t[a], t[b])});
        }
      }
      list.nodes.assign(edges.begin(), edges.end());
    }
    scene.bodies = {body};
    scene.gravity = {0, -9.81, 0};
    scene.dt = 2e-4;
    const auto sim = simulate(scene, GetParam());
    ASSERT_EQ(sim->model().links.springs.size(), 1U);
    sim->advance(1500);
    moved[listed ? 1 : 0] = sim->displacements(0);
  }
  double error = 0;
  for (std::size_t n = 0; n < moved[0].size(); ++n) error = std::max(error, vec::norm(vec::sub(moved[0][n], moved[1][n])));
  ASSERT_GT(largest(moved[0]), 0.005);
  check("listed edges against edges, over the largest displacement", error / largest(moved[0]), bound(2e-4, 1e-10));
}

/// A beam clamped at one end with a tendon T at a distance e from its axis is bent by a moment T e: its end rises by T e L^2 /
/// (2 E I).
TEST_P(SpringLists, ATendonBendsABeamByItsMoment) {
  const double edge = 0.005, young = 8000, tension = 2e-4;
  const int n = 30;
  Scene scene;
  Body beam = box_body({{n, 4, 4}, edge}, Discretization::hex8, material_young(Law::neo_hookean, young, 0));
  beam.material.damping = 20;
  beam.fixed.push_back({face(0, 0), {true, true, true}});
  SpringList& tendon = beam.springs.emplace_back();
  tendon.spring.law = SpringLaw::curve;  // of constant force
  tendon.spring.curve = {{-1, tension}, {1, tension}};
  const auto node = [&](int i, int j, int k) { return i + (n + 1) * (j + 5 * k); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 5; ++k) tendon.nodes.push_back({node(i, 4, k), node(i + 1, 4, k)});
  }
  scene.bodies = {beam};
  scene.relaxation.enabled = true;
  scene.relaxation.tolerance = 1e-4;
  const auto sim = simulate(scene, GetParam());
  settle(*sim);
  const double length = n * edge, inertia = std::pow(4 * edge, 4) / 12;
  check_relative("T e L^2 / (2 E I)", sim->displacements(0)[node(n, 2, 2)][1],
                 5 * tension * 2 * edge * length * length / (2 * young * inertia), 0.03);
}

/// Pieces of the ends of the springs of a list.
void expect_within_pieces(const Model& model, const std::string& name) {
  const std::vector<std::int32_t> of = pieces_of_slots(model.bodies[0], model.slots);
  for (const SpringBatch& batch : model.links.springs) {
    for (const auto& [from, to] : batch.points) {
      const std::int32_t a = of[model.links.points.slots[from][0]], b = of[model.links.points.slots[to][0]];
      EXPECT_TRUE(a >= 0 && a == b) << name << ": a spring across the cut";
    }
  }
}

TEST_P(SpringLists, ACutBreaksThoseThatItCrosses) {
  for (const bool separate : {false, true}) {
    for (const Discretization cut :
         std::vector{Discretization::tet4, separate ? Discretization::hex8 : Discretization::tet4anp}) {
      Scene scene = box_scene(cut, {long_springs(false)});
      scene.cuttable = true;
      scene.least_fill = 0;
      if (separate) {
        Blade far;
        far.name = "far";
        far.path = {{8, 7, 7, 7, 7, 7, 8}, {9, 7, 7, 8, 7, 7, 9}};
        far.method = BladeMethod::separation;
        scene.blades = {far};
      }
      const auto sim = simulate(scene, GetParam());
      sim->advance(50);
      const std::size_t before = sim->model().links.springs[0].size();
      const double at = 0.31;  // between the rows of nodes i = 2 and i = 3
      const Vec3d a{at, -9, -1}, b{at, 9, -1}, c{at, 0, 20};
      sim->cut(std::array<SweepTriangle, 1>{{{a, b, c}}});
      const std::string name = name_of(cut) + std::string(separate ? ", separation" : "");
      EXPECT_EQ(pieces_of(sim->model().bodies[0]), 2) << name;
      EXPECT_EQ(before, 20U);
      ASSERT_EQ(sim->model().links.springs.size(), 1U) << name;
      EXPECT_EQ(sim->model().links.springs[0].size(), 5U) << name << ": those across x stay";
      expect_within_pieces(sim->model(), name);
      sim->advance(200);
      EXPECT_FALSE(sim->divergence().has_value()) << name;
    }
  }
}

/// A cut that ends inside breaks what it crosses, but for what is less than an element from its end, and nothing else.
TEST_P(SpringLists, APartialCutLeavesTheRest) {
  Scene scene = box_scene(Discretization::tet4, {long_springs(false)});
  scene.cuttable = true;
  const auto sim = simulate(scene, GetParam());
  const double x = 0.31, z = 0.3;  // of 0 to 0.75 and 0 to 0.5
  const Vec3d a{x, -1, -1}, b{x, 2, -1}, c{x, -1, z}, d{x, 2, z};
  sim->cut(std::array<SweepTriangle, 2>{SweepTriangle{a, b, c}, SweepTriangle{b, d, c}});
  EXPECT_EQ(pieces_of(sim->model().bodies[0]), 1);
  const Model& model = sim->model();
  std::map<double, int> across;  // by z
  int along = 0;
  for (const auto& [from, to] : model.links.springs[0].points) {
    const Vec3d &p = model.links.points.rest[from], &q = model.links.points.rest[to];
    (p[0] == q[0] ? along : across[p[2]]) += 1;
  }
  EXPECT_EQ(along, 5);
  EXPECT_EQ(across[0], 0);
  EXPECT_LT(across[0.25], 5);
  EXPECT_EQ(across[0.5], 5);
}

PLIANT_ON_BACKENDS(SpringLists);

}  // namespace
}  // namespace pliant::physics::spring_lists_test
