// Homogeneous stress of every law against closed forms: at rest after dynamic relaxation, and for imposed deformations.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

/// The distorted unit block of every stress test (a lattice is regular).
Box block() { return {{2, 2, 2}, 0.5, 0.15, 7}; }

Scene quasi_static(const Body& body, double tolerance) {
  Scene scene;
  scene.bodies = {body};
  scene.safety = 0.4;  // the block stiffens while it is pulled
  scene.relaxation.enabled = true;
  scene.relaxation.tolerance = tolerance;
  return scene;
}

/// The resultant of the internal forces on the nodes in the rest plane x_axis = at, along the axis [N].
double face_force(const Model& model, const std::vector<Vec3d>& f, int axis, double at) {
  double sum = 0;
  for (std::int32_t s = 0; s < model.slots; ++s) {
    if (model.mass[s] > 0 && std::abs(model.rest[s][axis] - at) < 1e-6) sum -= f[s][axis];
  }
  return sum;
}

/// First Piola stress at the pulled face x = 1 with the axes in `pulled` stretched and the others free.
double stress_at_rest(const char* backend, Discretization cut, const Material& m, double stretch, int pulled,
                      double tolerance) {
  Body body = box_body(block(), cut, m);
  for (int axis = 0; axis < 3; ++axis) {
    body.fixed.push_back(roller(axis));
    if (axis < pulled) body.prescribed.push_back(pull(axis, 1, stretch - 1, smooth(5)));
  }
  auto sim = simulate(quasi_static(body, tolerance), backend);
  settle(*sim);
  return face_force(sim->model(), forces(*sim), 0, 1);
}

/// The same from the law: the free stretches are those without stress.
double closed_form(const Material& m, double stretch, int pulled) {
  const auto stress = [&](double lateral, int row) {
    const Vector3d stretches(stretch, pulled > 1 ? stretch : lateral, lateral);
    return first_piola(stretches.asDiagonal(), m)(row, row);
  };
  const double lateral = root(0.2, 4, [&](double l) { return stress(l, 2); });
  return stress(lateral, 0);
}

/// The block with the affine deformation x = F X imposed on every node.
std::unique_ptr<Simulation> deformed_block(const char* backend, Discretization cut, const Material& m, const Matrix3d& f) {
  Scene scene;
  scene.bodies = {box_body(block(), cut, m)};
  auto sim = simulate(scene, backend);
  const Matrix3d gradient = f - Matrix3d::Identity();
  write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(gradient * x); }));
  return sim;
}

class Stress : public OnBackend {
 protected:
  void compare(Law law, double mu, double kappa, int pulled, double stretch, double exact) {
    const Material m = material(law, mu, kappa);
    check_relative("closed form against the published figure", closed_form(m, stretch, pulled), exact, 2e-6);
    for (const Discretization cut : all_cuts()) {
      const double p = stress_at_rest(GetParam(), cut, m, stretch, pulled, bound(1e-5, 1e-8));
      check_relative(std::string(name_of(cut)) + " stretch " + std::to_string(stretch), p, closed_form(m, stretch, pulled),
                     bound(1e-4, 1e-7));
    }
  }
};

TEST_P(Stress, UniaxialIsochoric) {
  for (const auto& [stretch, p] :
       std::vector<std::array<double, 2>>{{0.7, -1333.609}, {0.8, -758.210}, {1.1, 271.552}, {1.3, 701.880}, {2.0, 1718.807}}) {
    compare(Law::isochoric_neo_hookean, 1000, 50000, 1, stretch, p);
  }
}

TEST_P(Stress, EquibiaxialIsochoric) {
  for (const auto& [stretch, p] : std::vector<std::array<double, 2>>{{0.8, -2144.101}, {1.2, 781.706}, {1.5, 1338.184}}) {
    compare(Law::isochoric_neo_hookean, 1000, 50000, 2, stretch, p);
  }
}

TEST_P(Stress, UniaxialAndEquibiaxialEveryLaw) {
  for (const Law law : all_laws()) {
    const Material m = material_young(law, 3000, 0.45);
    for (const double stretch : {0.8, 1.3}) compare(law, m.moduli.mu, m.moduli.kappa, 1, stretch, closed_form(m, stretch, 1));
    compare(law, m.moduli.mu, m.moduli.kappa, 2, 1.2, closed_form(m, 1.2, 2));
  }
  // Saint-Venant-Kirchhoff in one dimension: P = s E (s^2 - 1) / 2.
  const Material m = material_young(Law::saint_venant_kirchhoff, 3000, 0.45);
  check_relative("the root solve against s E (s^2 - 1) / 2", closed_form(m, 1.3, 1), 1.3 * 3000 * (1.69 - 1) / 2, 1e-9);
}

/// Nodal forces of an imposed affine deformation give the law's mean stress.
TEST_P(Stress, SimpleShear) {
  Matrix3d f = Matrix3d::Identity();
  f(0, 1) = 0.5;
  for (const Law law : all_laws()) {
    const Material m = material(law, 1000, 50000);
    for (const Discretization cut : all_cuts()) {
      auto sim = deformed_block(GetParam(), cut, m, f);
      const Matrix3d cauchy = mean_stress(sim->model(), forces(*sim), 1) * f.transpose();
      const Matrix3d exact = law == Law::isochoric_neo_hookean
                                 ? (Matrix3d() << 166.6666667, 500, 0, 500, -83.3333333, 0, 0, 0, -83.3333333).finished()
                                 : Matrix3d(first_piola(f, m) * f.transpose());
      check(std::string(name_of(cut)) + " " + to_string(law) + " simple shear 0.5: 12, 11, 22 relative",
            (cauchy - exact).cwiseAbs().maxCoeff() / exact.norm(), bound(1e-5, 1e-9));
    }
  }
}

/// Finite rotation, volume change and shear at once: every component of P, every law, every element.
TEST_P(Stress, ArbitraryDeformation) {
  const Matrix3d stretch = (Matrix3d() << 1.2, 0.1, -0.05, 0.1, 0.85, 0.08, -0.05, 0.08, 1.1).finished();
  const Matrix3d f = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix() * stretch;
  for (const Law law : all_laws()) {
    const Material m = material(law, 1000, 9000);
    for (const Discretization cut : all_cuts()) {
      auto sim = deformed_block(GetParam(), cut, m, f);
      const Matrix3d p = mean_stress(sim->model(), forces(*sim), 1), exact = first_piola(f, m);
      check(std::string(name_of(cut)) + " " + to_string(law) + " P relative", (p - exact).norm() / exact.norm(),
            bound(1e-5, 1e-13));
      // The nodes inside feel nothing.
      double inside = 0;
      const auto force = forces(*sim);
      for (std::int32_t s = 0; s < sim->model().slots; ++s) {
        const Vector3d x = eigen(sim->model().rest[s]);
        if (sim->model().mass[s] > 0 && x.minCoeff() > 0.01 && x.maxCoeff() < 0.99)
          inside = std::max(inside, eigen(force[s]).norm());
      }
      check(std::string(name_of(cut)) + " force on inner nodes", inside / exact.norm(), bound(2e-6, 1e-14));
    }
  }
}

/// One 0.1 m hexahedron, mu 1052, kappa 52249, confined 30 % stretch.
TEST_P(Stress, ConfinedSingleElement) {
  const Material m = material(Law::isochoric_neo_hookean, 1052, 52249);
  for (const Discretization cut : all_cuts()) {
    Body body = box_body({{1, 1, 1}, 0.1}, cut, m);
    for (int axis = 0; axis < 3; ++axis) body.fixed.push_back(roller(axis));
    for (int axis = 1; axis < 3; ++axis) body.fixed.push_back(roller(axis, 0.1));
    body.prescribed.push_back(pull(0, 0.1, 0.03, smooth(0.01)));
    Scene scene;
    scene.bodies = {body};
    scene.dt = 1e-4;  // every node is prescribed: nothing is left to move, and there is no stable step
    SimulationOptions options;
    options.stable_step = false;
    auto sim = simulate(scene, GetParam(), options);
    sim->advance(120);
    const auto f = forces(*sim);
    const double force = face_force(sim->model(), f, 0, 0.1);
    const auto u = read_texels(*sim, "node_u");
    const Energies energy = energies(sim->model(), u, std::vector<Vec3d>(sim->model().slots));
    const std::string name = name_of(cut);
    check_relative(name + " face force [N]", force, 159.872, bound(1e-4, 2e-6));
    // The deformed face is the rest face: Cauchy stress = force / area.
    check_relative(name + " Cauchy stress [Pa]", force / 0.01, 15987.21, bound(1e-4, 1e-6));
    check_relative(name + " energy [J]", energy.strain + energy.hourglass, 2.402688, bound(1e-4, 1e-6));
  }
}

PLIANT_ON_BACKENDS(Stress);

}  // namespace
}  // namespace pliant::physics
