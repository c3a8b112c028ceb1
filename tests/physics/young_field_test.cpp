// A modulus per element: against the closed form of a confined bar, against inclusions and the static solver, through cuts.
#include "model/elements/body_mesh.h"
#include "model/elements/each_element.h"
#include "physics/harness.h"
#include "simulation/measure/probing.h"
#include "statics/statics.h"
#include "support/error_of.h"

namespace pliant::physics::young_field_test {
namespace {

constexpr double kPoisson = 0.3;
const std::vector<double> kSlabs{8000, 1000, 4000, 500};  ///< moduli along x [Pa]

Box bar() { return {{8, 2, 2}, 0.25, 0, 3}; }

std::size_t slab_of(const Vec3d& x) { return static_cast<std::size_t>(x[0] / (2 * bar().edge)); }

template <std::size_t N>
double young_at(const VolumeMesh& mesh, const std::array<std::int32_t, N>& element) {
  double x = 0;
  for (const std::int32_t n : element) x += mesh.vertices[n][0] / N;
  return kSlabs[slab_of({x, 0, 0})];
}

/// The material whose moduli are those of the elements of `mesh`, as a file would give them.
Material varied(Law law, const VolumeMesh& mesh) {
  auto field = std::make_shared<YoungField>();
  field->name = "E";
  field->poisson = kPoisson;
  for (const auto& tet : mesh.tets) field->values.push_back(young_at(mesh, tet));
  for (const auto& hex : mesh.hexes) field->values.push_back(young_at(mesh, hex));
  field->largest = *std::max_element(field->values.begin(), field->values.end());
  Material m = material_young(law, field->largest, kPoisson);
  m.young_field = field;
  return m;
}

/// Confined on all sides and pulled at its end: every slab is strained along x alone, and bears the same stress.
Scene confined(Discretization cut, const Material& m, double way) {
  Body body = box_body(bar(), cut, m);
  const Vec3d size = bar().size();
  for (int axis = 0; axis < 3; ++axis) body.fixed.push_back(roller(axis));
  body.fixed.push_back(roller(1, size[1]));
  body.fixed.push_back(roller(2, size[2]));
  body.prescribed.push_back(pull(0, size[0], way, smooth(5)));
  Scene scene;
  scene.bodies = {body};
  scene.safety = 0.5;
  scene.relaxation.enabled = true;
  return scene;
}

double stress_of(const Material& m, double stretch) { return first_piola(Vector3d(stretch, 1, 1).asDiagonal(), m)(0, 0); }

/// The stress of the bar whose slabs have these stretches in sum [Pa].
double closed_form(Law law, double way) {
  const double length = bar().size()[0], share = length / static_cast<double>(kSlabs.size());
  const auto longer = [&](double stress) {
    double sum = 0;
    for (const double young : kSlabs) {
      const Material m = material_young(law, young, kPoisson);
      sum += share * (root(0.3, 4, [&](double s) { return stress_of(m, s) - stress; }) - 1);
    }
    return sum;
  };
  return root(0, 2000, [&](double stress) { return longer(stress) - way; });
}

/// In the middle of each slab, along the bar; strained along x alone its true stress is that on the area at rest.
std::vector<double> stresses(Simulation& sim) {
  std::vector<SceneProbe> probes;
  for (std::size_t i = 0; i < kSlabs.size(); ++i) {
    SceneProbe probe;
    probe.name = "slab " + std::to_string(i);
    probe.point = Vec3d{2 * bar().edge * (static_cast<double>(i) + 0.4), 0.3, 0.2};
    probe.quantities = {Quantity::stress};
    probes.push_back(probe);
  }
  std::vector<double> out;
  for (const ProbeState& state : PlacedProbes(probes, sim.model()).states(sim)) out.push_back((*state.stress)[0]);
  return out;
}

class YoungField : public OnBackend {};

TEST_P(YoungField, SlabsInSeriesBearOneStress) {
  const double way = 0.1, size = bar().size()[1] * bar().size()[2];
  for (const Law law : {Law::neo_hookean, Law::saint_venant_kirchhoff, Law::stable_neo_hookean}) {
    const double exact = closed_form(law, way);
    for (const Discretization cut : {Discretization::tet4, Discretization::hex8, Discretization::hex8full}) {
      Scene scene = confined(cut, varied(law, make_mesh(bar(), is_tet(cut))), way);
      scene.relaxation.tolerance = bound(1e-5, 1e-9);
      auto sim = simulate(scene, GetParam());
      settle(*sim);
      double force = 0;
      for (const Vec3d& f : sim->residual_forces(0)) force += std::max(0.0, -f[0]);
      const std::string what = std::string(to_string(law)) + " " + name_of(cut);
      check_relative(what, force / size, exact, bound(2e-4, 1e-6));
      for (const double stress : stresses(*sim))
        check_relative(what + ", true stress of a slab", stress, exact, bound(1e-3, 1e-6));
    }
  }
}

/// The same bar with a material for each slab instead.
TEST_P(YoungField, MovesLikeInclusionsWithTheirMaterials) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8, Discretization::hex8full}) {
    Scene field = confined(cut, varied(Law::neo_hookean, make_mesh(bar(), is_tet(cut))), 0);
    field.relaxation.enabled = false;
    field.bodies[0].prescribed.clear();
    field.gravity = {9, -5, 0};
    field.dt = 2e-4;
    Scene parts = field;
    parts.bodies[0].material = material_young(Law::neo_hookean, kSlabs[0], kPoisson);
    for (std::size_t i = 1; i < kSlabs.size(); ++i) {
      Inclusion slab;
      slab.where.kind = Selection::Kind::box;
      slab.where.a = {2 * bar().edge * static_cast<double>(i), -1, -1};
      slab.where.b = {2 * bar().edge * static_cast<double>(i + 1), 3, 3};
      slab.material = material_young(Law::neo_hookean, kSlabs[i], kPoisson);
      parts.bodies[0].inclusions.push_back(slab);
    }
    auto one = simulate(field, GetParam()), other = simulate(parts, GetParam());
    one->advance(500), other->advance(500);
    const auto u = one->displacements(0), v = other->displacements(0);
    double most = 0, difference = 0;
    for (std::size_t n = 0; n < u.size(); ++n) {
      most = std::max(most, eigen(v[n]).norm());
      difference = std::max(difference, (eigen(u[n]) - eigen(v[n])).norm());
    }
    EXPECT_GT(most, 0.01);
    check(std::string(name_of(cut)) + " against inclusions, relative", difference / most, bound(2e-4, 1e-9));
    check_relative("stable step", one->stable_dt(), other->stable_dt(), 0.03);
    const auto energy = [](const Simulation& s) {
      const std::vector<std::vector<Vec3d>> at{s.displacements(0)}, to{s.velocities(0)};
      return energies(s.model(), by_slot(s.model(), at), by_slot(s.model(), to), {{}, s.time()});
    };
    check_relative("strain energy", energy(*one).strain, energy(*other).strain, bound(1e-3, 1e-8));
  }
}

TEST_P(YoungField, RestsWhereTheStaticSolverSays) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8full}) {
    Scene scene = confined(cut, varied(Law::neo_hookean, make_mesh(bar(), is_tet(cut))), 0);
    scene.bodies[0].prescribed.clear();
    scene.gravity = {0.4, -0.3, 0};
    scene.relaxation.tolerance = bound(1e-5, 1e-9);
    auto sim = simulate(scene, GetParam());
    settle(*sim);
    const auto solution = statics::solve(statics::problem_of(scene, sim->model(), 0));
    ASSERT_TRUE(solution.converged) << solution.failure;
    double most = 0, difference = 0;
    const auto u = sim->displacements(0);
    for (std::size_t n = 0; n < u.size(); ++n) {
      most = std::max(most, eigen(solution.displacement[n]).norm());
      difference = std::max(difference, (eigen(u[n]) - eigen(solution.displacement[n])).norm());
    }
    check(std::string(name_of(cut)) + " against the static solver, relative", difference / most, bound(1e-3, 1e-6));
  }
}

PLIANT_ON_BACKENDS(YoungField);

TEST(YoungFieldValues, ThatAreNoModuliAreRefused) {
  for (const double wrong : {-1.0, 0.0, std::nan("")}) {
    Scene scene;
    scene.bodies = {box_body(bar(), Discretization::tet4, varied(Law::neo_hookean, make_mesh(bar(), true)))};
    scene.bodies[0].pointer = "/bodies/0";
    auto field = std::make_shared<pliant::YoungField>(*scene.bodies[0].material.young_field);
    field->values[17] = wrong;
    scene.bodies[0].material.young_field = field;
    const std::string message = test::error_of([&] { build_model(scene); });
    EXPECT_NE(message.find("/bodies/0/material/young: got "), std::string::npos) << message;
    EXPECT_NE(message.find(" Pa of element 17 in the field \"E\", expected a modulus > 0"), std::string::npos) << message;
  }
}

/// A copy of a cut element is as stiff as the element was, wherever the blade goes.
TEST(YoungFieldCut, CopiesKeepTheModulusOfTheirElement) {
  const VolumeMesh mesh = make_mesh(bar(), true);
  Scene scene;
  scene.bodies = {box_body(bar(), Discretization::tet4, varied(Law::neo_hookean, mesh))};
  scene.cuttable = true;
  Simulation s(scene, open_backend("cpu"));
  const std::size_t before = s.model().bodies[0].tets.size();
  const Vec3d a{-1, 0.23, -1}, b{4, 0.31, -1}, c{4, 0.27, 4}, d{-1, 0.19, 4};
  const std::vector<SweepTriangle> sheet{{a, b, c}, {a, c, d}};
  s.cut(sheet);
  const ModelBody& body = s.model().bodies[0];
  ASSERT_GT(body.tets.size(), before + 50);
  ASSERT_EQ(body.materials.modulus.size(), body.tets.size());
  for_each_element(s.model(), [&](const ElementView& e) {
    double x = 0;
    for (const std::int32_t n : body.tets[static_cast<std::size_t>(e.id)]) x += body.rest[n][0] / 4;
    EXPECT_DOUBLE_EQ(e.modulus, kSlabs[slab_of({x, 0, 0})] / 8000) << e.id;
  });
}

}  // namespace
}  // namespace pliant::physics::young_field_test
