// Membranes on bodies of every kind: stress of an affine field, forces against differences of the energy, an inflated ball, and
// what a cut leaves of them.
#include "cutting/blade/blade.h"
#include "model/links/membranes.h"
#include "physics/harness.h"
#include "support/unit_ball.h"

namespace pliant::physics {
namespace {

class MembranePhysics : public OnBackend {};

constexpr Membrane capsule{.thickness = 0.01, .young = 50000, .poisson = 0.3, .density = 1200};

Scene coated(const Box& box, Discretization cut) {
  Scene scene;
  scene.bodies = {box_body(box, cut, material_young(Law::neo_hookean, 3000, 0.4))};
  scene.bodies[0].membrane = capsule;
  return scene;
}

/// Sum of V P of the six faces of a box whose points move by H X: P = F T S T^T with the tangents T of a face.
Matrix3d membrane_moment(const Box& box, const Matrix3d& h) {
  const Matrix3d f = Matrix3d::Identity() + h;
  const double c = capsule.stiffness();
  Matrix3d sum = Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    Eigen::Matrix<double, 3, 2> t;
    t << Vector3d::Unit(first), Vector3d::Unit(second);
    const Eigen::Matrix2d e = (t.transpose() * f.transpose() * f * t - Eigen::Matrix2d::Identity()) / 2;
    const Eigen::Matrix2d s = c * ((1 - capsule.poisson) * e + capsule.poisson * e.trace() * Eigen::Matrix2d::Identity());
    sum += 2 * box.size()[first] * box.size()[second] * capsule.thickness * f * t * s * t.transpose();
  }
  return sum;
}

TEST_P(MembranePhysics, AnAffineFieldHasTheStressOfTissueAndMembrane) {
  const Box box{{3, 2, 2}, 0.25, 0, 3};
  const Matrix3d h = (Matrix3d() << 0.10, 0.05, -0.02, 0.03, -0.08, 0.04, -0.01, 0.06, 0.07).finished();
  for (const Discretization cut : all_cuts()) {
    const Scene scene = coated(box, cut);
    auto sim = simulate(scene, GetParam());
    write_texels(*sim, "node_u", displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(h * x); }));
    const Matrix3d exact =
        first_piola(Matrix3d::Identity() + h, scene.bodies[0].material) + membrane_moment(box, h) / box.volume();
    const Matrix3d p = mean_stress(sim->model(), forces(*sim), box.volume());
    check(std::string(name_of(cut)) + " mean stress", (p - exact).norm() / exact.norm(), bound(2e-5, 1e-12));
    const double area = 2 * (0.75 * 0.5 + 0.5 * 0.5 + 0.75 * 0.5);
    check_relative(std::string(name_of(cut)) + " mass", sim->model().bodies[0].mass,
                   1000 * box.volume() + capsule.density * capsule.thickness * area, 1e-12);
  }
}

TEST_P(MembranePhysics, ForcesAreTheDerivativeOfTheEnergy) {
  if (!in_double()) GTEST_SKIP() << "differences of energies need double";
  for (const Discretization cut : all_cuts()) {
    if (cut == Discretization::tet4anp) continue;  // its elements average over nodes, as tests/physics/patch_test.cpp has it
    Scene scene = coated({{2, 2, 2}, 0.5, 0, 3}, cut);
    auto sim = simulate(scene, GetParam());
    std::mt19937 random(7);
    const auto draw = [&](double size) {
      std::vector<Vec3d> out(sim->model().slots);
      for (Vec3d& x : out) {
        for (double& c : x) c = size * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1);
      }
      return out;
    };
    const std::vector<Vec3d> u = draw(0.05), way = draw(1), none(sim->model().slots);
    write_texels(*sim, "node_u", u);
    const std::vector<Vec3d> f = forces(*sim);
    double power = 0;
    for (std::size_t s = 0; s < f.size(); ++s) {
      if (sim->model().mass[s] > 0) power -= vec::dot(f[s], way[s]);
    }
    const auto energy = [&](double step) {
      std::vector<Vec3d> at = u;
      for (std::size_t s = 0; s < at.size(); ++s) at[s] = vec::add(at[s], vec::mul(way[s], step));
      const Energies e = energies(sim->model(), at, none);
      return e.strain + e.hourglass;
    };
    check_relative(std::string(name_of(cut)) + " power", power, (energy(1e-5) - energy(-1e-5)) / 2e-5, 1e-6);
  }
}

TEST_P(MembranePhysics, RigidMotionIsForceFree) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    auto sim = simulate(coated({{3, 2, 2}, 0.25, 0, 3}, cut), GetParam());
    const Matrix3d turn = Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    write_texels(*sim, "node_u",
                 displaced(sim->model(), [&](const Vector3d& x) { return Vector3d(turn * x - x + Vector3d(0.1, 0.2, 0)); }));
    check(std::string(name_of(cut)) + " force / (E t edge)", largest(forces(*sim)) / (capsule.young * capsule.thickness * 0.25),
          bound(2e-6, 1e-14));
  }
}

/// A ball under a pressure from inside: p = 2 t E / (1 - nu) e / r of the membrane and 3 K e of the tissue, e small.
TEST_P(MembranePhysics, AnInflatedBall) {
  TriangleMesh ball = test::unit_ball(24);
  constexpr double radius = 0.05, strain = 0.01;
  for (Vec3d& x : ball.vertices) x = vec::mul(x, radius);
  Body body;
  body.name = "ball";
  body.surface = save(ball);
  body.lattice.spacing = 0.01;
  body.material = material_young(Law::neo_hookean, 600, 0);
  body.material.damping = 60;
  body.membrane = Membrane{.thickness = 2e-4, .young = 1e6, .poisson = 0.4};
  const double of_membrane = 2 * body.membrane->thickness * body.membrane->young / 0.6 * strain / radius;
  const double pressure = of_membrane + 600 * strain;  // 3 K = E / (1 - 2 nu)
  body.pressures.push_back({all_nodes(), -pressure, smooth(0.2)});
  Scene scene;
  scene.bodies = {body};
  auto sim = simulate(scene, GetParam());
  while (sim->time() < 0.8) sim->advance(64);
  const Model& model = sim->model();
  const std::vector<Vec3d> u = read_texels(*sim, "node_u");
  const auto volume = [&](double moved) {
    TriangleMesh now;
    for (std::size_t v = 0; v < model.surface.rest.size(); ++v) {
      Vec3d x = model.surface.rest[v];
      for (std::size_t a = 0; a < 8; ++a)
        x = vec::add(x, vec::mul(u[static_cast<std::size_t>(model.surface.nodes[v][a])], moved * model.surface.weights[v][a]));
      now.vertices.push_back(x);
    }
    now.triangles = model.surface.triangles;
    return signed_volume(now);
  };
  check_relative("radius's growth", std::cbrt(volume(1) / volume(0)) - 1, strain, 0.02);
}

double membrane_area(const Model& model) {
  double sum = 0;
  for (const MembraneBatch& b : model.links.membranes) {
    for (const Membrane::Record& r : b.records) sum += r.back() / b.law.thickness;
  }
  return sum;
}

TEST_P(MembranePhysics, ACutDividesItAndKeepsMomentum) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8_bricks}) {
    Scene scene = coated({{4, 3, 3}, 0.02, 0, 3}, cut);
    scene.cuttable = true;
    scene.least_fill = 0;  // its inertia would come on top
    scene.bodies[0].membrane->thickness = 2e-4;
    scene.bodies[0].angular_velocity = {1, 2, 3};
    auto sim = simulate(scene, GetParam());
    sim->advance(50);
    const double area = membrane_area(sim->model()), mass = sim->model().bodies[0].mass;
    const Momenta before = momenta_of(*sim);
    const Vec3d a{0.0437, -1, -1}, b{0.0437, 1, -1}, c{0.0437, 0, 2};
    sim->cut(std::array<SweepTriangle, 1>{{{a, b, c}}});
    const std::string name = name_of(cut);
    check(name + " area", membrane_area(sim->model()) / area - 1, 0.02);
    check(name + " mass", sim->model().bodies[0].mass / mass - 1, 1e-3);
    const Momenta after = momenta_of(*sim);
    check(name + " momentum", vec::norm(vec::sub(after.linear, before.linear)) / (mass * 0.1), 1e-5);
    sim->advance(200);
    EXPECT_FALSE(sim->divergence().has_value());
  }
}

PLIANT_ON_BACKENDS(MembranePhysics);

}  // namespace
}  // namespace pliant::physics
