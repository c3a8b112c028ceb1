// Kelvin and Voigt's viscous stress: bars without lateral contraction that swing and creep as closed forms say, on every
// element.
#include "physics/harness.h"

namespace pliant::physics::viscosity_test {
namespace {

class Viscosity : public OnBackend {};

constexpr double kYoung = 3000, kLength = 0.1;

/// Every viscous force is `time` times the elastic one of the same motion, so that each mode is Kelvin and Voigt's element.
Material viscous_material(double time) {
  Material m = material_young(Law::neo_hookean, kYoung, 0);
  m.viscosity = time * m.moduli.mu;
  m.bulk_viscosity = time * m.moduli.kappa;
  return m;
}

/// A bar that is held at x = 0 and moves along x only.
Body bar(Discretization cut, int cells, const Material& material) {
  Body body = box_body({{cells, 1, 1}, kLength / cells}, cut, material);
  body.fixed.push_back({all_nodes(), {false, true, true}});
  body.fixed.push_back({face(0, 0), {true, true, true}});
  return body;
}

double tip(const Simulation& sim) {
  double sum = 0;
  int nodes = 0;
  const auto u = sim.displacements(0);
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (sim.model().bodies[0].rest[n][0] < kLength - 1e-6) continue;
    sum += u[n][0];
    ++nodes;
  }
  return sum / nodes;
}

/// First frequency of the bar as a continuum [1/s].
double first_omega() { return M_PI / (2 * kLength) * std::sqrt(kYoung / 1000); }

struct Decay {
  double rate, omega2;  ///< [1/s], square of the frequency without damping [1/s^2]
};

/// Of the free vibration of a bar.
Decay free_decay(Simulation& sim) {
  std::vector<double> crossings, peaks;
  double before = tip(sim), peak = 0;
  while (crossings.size() < 8 && sim.step() < 8000) {
    sim.advance(1);
    const double now = tip(sim);
    if (before * now < 0) {
      crossings.push_back(sim.time() - sim.dt() * now / (now - before));
      peaks.push_back(peak);
      peak = 0;
    }
    peak = std::max(peak, std::abs(now));
    before = now;
  }
  EXPECT_EQ(crossings.size(), 8U);
  crossings.resize(8), peaks.resize(8);
  // The first swings hold higher modes, which are damped much more.
  const double half = (crossings[7] - crossings[2]) / 5, rate = std::log(peaks[3] / peaks[7]) / (4 * half);
  return {rate, M_PI * M_PI / (half * half) + rate * rate};
}

/// A free vibration decays as exp(-delta t), delta = eta omega^2 / (2 E) with eta the viscosity of the bar; its own omega.
TEST_P(Viscosity, AFreeVibrationDecays) {
  const double time = 0.1 / first_omega();
  for (const Discretization cut : all_cuts()) {
    Body body = bar(cut, 4, viscous_material(time));
    AffineField stretch;
    stretch.linear[0] = {1e-3, 0, 0};
    body.initial.push_back({all_nodes(), {}, stretch});
    Scene scene;
    scene.bodies = {body};
    scene.dt = 5e-4;
    auto sim = simulate(scene, GetParam());
    const auto [decay, omega2] = free_decay(*sim);
    check_relative(std::string(name_of(cut)) + " decay rate [1/s]", decay, time * omega2 / 2, 0.01);
    check_relative(std::string(name_of(cut)) + " omega of the first mode [1/s]", std::sqrt(omega2), first_omega(), 0.02);
  }
}

/// Springs with dampers in proportion to their stiffness: xi = b omega / 2, whatever omega the network has.
TEST_P(Viscosity, ANetworkOfSpringsDecays) {
  for (const double given : {0.0, 15.0}) {  // stiffness of each spring [N/m]; 0: from the material
    Material m = material_young(Law::neo_hookean, kYoung, 0.25);
    m.stiffness_damping = 0.1 / first_omega();
    Body body = bar(Discretization::tet4, 4, m);
    body.model.type = ModelType::mass_spring;
    body.model.spring.stiffness = given;
    AffineField stretch;
    stretch.linear[0] = {1e-3, 0, 0};
    body.initial.push_back({all_nodes(), {}, stretch});
    Scene scene;
    scene.bodies = {body};
    scene.dt = 2e-4;
    auto sim = simulate(scene, GetParam());
    const auto [decay, omega2] = free_decay(*sim);
    check_relative("decay rate of the network [1/s]", decay, m.stiffness_damping * omega2 / 2, 0.02);
  }
}

/// The stiffness-proportional part of Rayleigh's damping is a viscosity of b mu and b kappa.
TEST_P(Viscosity, StiffnessDampingIsTheViscosityOfItsModuli) {
  for (const Discretization cut : all_cuts()) {
    std::vector<std::uint64_t> hashes;
    for (const bool by_time : {false, true}) {
      Material m = viscous_material(by_time ? 0 : 0.01);
      m.stiffness_damping = by_time ? 0.01 : 0;
      Body body = bar(cut, 3, m);
      body.velocity = {0.1, 0, 0};
      Scene scene;
      scene.bodies = {body};
      auto sim = simulate(scene, GetParam());
      sim->advance(50);
      hashes.push_back(sim->hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]) << name_of(cut);
  }
}

/// Under a constant load it creeps: u = F L / (E A) (1 - exp(-t E / eta)), where inertia is small. The step is automatic.
TEST_P(Viscosity, ABarCreeps) {
  if (!in_double()) GTEST_SKIP() << "so slow a motion is below what float resolves in one step";
  const double time = 40 / first_omega();
  for (const Discretization cut : all_cuts()) {
    Body body = bar(cut, 2, viscous_material(time));
    const double area = kLength * kLength / 4, stress = 1e-3 * kYoung;
    body.forces.push_back({face(0, kLength), {stress * area, 0, 0}, {}});
    Scene scene;
    scene.bodies = {body};
    auto sim = simulate(scene, GetParam());
    double first = 0, exact_first = 0;
    for (const double at : {0.25, 1.0, 2.0}) {
      sim->advance(static_cast<std::int64_t>(std::round((at * time - sim->time()) / sim->dt())));
      ASSERT_FALSE(sim->divergence()) << name_of(cut);
      const std::string name = std::string(name_of(cut)) + " at " + std::to_string(at) + " of its time ";
      const double now = tip(*sim), exact = stress / kYoung * kLength * (1 - std::exp(-sim->time() / time));
      // Tetrahedra are loaded unevenly by equal forces, statically too: their end is another by 2 %.
      check_relative(name + "creep [m]", now, exact, is_tet(cut) ? 0.03 : 0.002);
      if (first > 0) check_relative(name + "over the first", now / first, exact / exact_first, 0.003);
      if (first == 0) first = now, exact_first = exact;
    }
  }
}

/// The step that the bound says: a little less is stable, a little more is not. `shares`: viscous times over the elastic step.
/// `expected`: the step from both.
template <class Expected>
void expect_step(Integrator integrator, std::initializer_list<double> shares, Expected expected) {
  for (const double share : shares) {
    const auto run = [&](Integrator by, double time, double dt) {
      Body body = bar(Discretization::hex8full, 2, viscous_material(time));
      body.velocity = {1e-6, 0, 0};
      Scene scene;
      scene.bodies = {body};
      scene.dt = dt;
      scene.integrator = by;
      SimulationOptions options;
      options.stable_step = true;
      return simulate(scene, "cpu:double", options);
    };
    const double elastic = run(Integrator::increment, 0, 0)->stable_dt(), time = share * elastic;
    const double stable = run(integrator, time, 0)->stable_dt();
    check_relative("stable step over the elastic one", stable / elastic, expected(elastic, time) / elastic, 1e-6);
    const auto after = [&](double dt) {
      auto sim = run(integrator, time, dt);
      sim->advance(6000);
      return sim->divergence() ? 1e30 : std::abs(tip(*sim));
    };
    EXPECT_LT(after(0.98 * stable), 1e-6);
    EXPECT_GT(after(1.02 * stable), 1e-3);
  }
}

/// With the velocity of the last step, h = 2 / omega (sqrt(1 + xi^2) - xi), xi = time omega / 2.
TEST(ViscousStep, IsTheOneThatTheBoundSays) {
  expect_step(Integrator::increment, {0.1, 1.0, 10.0},
              [](double elastic, double time) { return std::sqrt(elastic * elastic + time * time) - time; });
}

/// Explicit Euler stands h = time of modes that swing, h = 2 / (time omega^2) of those that creep.
TEST(ViscousStep, OfForwardEulerToo) {
  expect_step(Integrator::forward_euler, {0.3, 10.0},
              [](double elastic, double time) { return std::min(time, elastic * elastic / (2 * time)); });
}

/// A free body that spins and swings keeps its angular momentum.
TEST_P(Viscosity, KeepsTheMomentumOfASpinningBody) {
  for (const Discretization cut : all_cuts()) {
    Scene scene;
    Body body = box_body({{3, 2, 2}, 0.05}, cut, viscous_material(2e-3));
    body.angular_velocity = {4, 6, -3};
    scene.bodies = {body};
    scene.dt = 2e-4;
    auto sim = simulate(scene, GetParam());
    const auto momentum = [&] {
      auto w = read_texels(*sim, "node_w");
      for (Vec3d& x : w) x = plain(eigen(x) / sim->dt());
      const Momenta m = momenta(sim->model(), read_texels(*sim, "node_u"), w);
      return Vector3d(eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear)));
    };
    const Vector3d before = momentum();
    sim->advance(2000);
    check(std::string(name_of(cut)) + " angular momentum after 2000 steps", (momentum() - before).norm() / before.norm(), 1e-4);
  }
}

/// What estimates, relaxation and probes ask for is the force of the elements alone: the evaluate-only form has no velocity.
TEST_P(Viscosity, TheForceThatIsOnlyAskedForHasNone) {
  const auto forces = [&](double time) {
    Body body = bar(Discretization::tet4, 4, viscous_material(time));
    AffineField stretch;
    stretch.linear[0] = {0.05, 0, 0};
    body.initial.push_back({all_nodes(), stretch, stretch});
    Scene scene;
    scene.bodies = {body};
    scene.dt = 1e-4;
    return simulate(scene, GetParam())->residual_forces(0);
  };
  EXPECT_EQ(forces(0.01), forces(0));
}

/// Viscous forces grow with the square of the stretch, the elastic ones of this law do not: at the step that their ratio at
/// rest allows, a bar that is drawn out to more than twice its length shakes with as much energy as it holds.
TEST_P(Viscosity, TheStepFollowsTheStretch) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8full_lattice}) {
    Body body = box_body({{6, 2, 2}, 0.01}, cut, viscous_material(0.05));
    body.fixed.push_back({face(0, 0), {true, true, true}});
    body.forces.push_back({face(0, 0.06), {2.5 * kYoung / 2 * 4e-4, 0, 0}, smooth(0.4)});
    Scene scene;
    scene.bodies = {body};
    auto sim = simulate(scene, GetParam());
    const double first = sim->dt();
    while (sim->time() < 0.6) {
      sim->advance(sim->next_batch(8));
      sim->watch_energy();
    }
    check(std::string(name_of(cut)) + " energy created", sim->report().energy.share().value(), 1e-4);
    check(std::string(name_of(cut)) + " trust lost", 1 - sim->state().limit.dt_backoff, 0);
    EXPECT_LT(sim->dt(), 0.6 * first) << name_of(cut);
    double longest = 0;
    for (const Vec3d& u : sim->displacements(0)) longest = std::max(longest, u[0]);
    EXPECT_GT(longest, 0.07) << name_of(cut);
  }
}

PLIANT_ON_BACKENDS(Viscosity);

}  // namespace
}  // namespace pliant::physics::viscosity_test
