// Every integrator of kernels/integrators.h in a whole simulation: one linear oscillator against its closed form.
#include "physics/harness.h"
#include "support/error_of.h"

namespace pliant::physics {
namespace {

class Integrators : public OnBackend {};

constexpr double kStretch = 1e-8;  ///< so small that the law is linear

/// A cube that can only swing along x: half of its mass on the spring (lambda + 2 mu) d.
struct Oscillator {
  Material material = material_young(Law::neo_hookean, 3000, 0.3);
  double edge = 0.1;
  [[nodiscard]] double omega() const {
    return std::sqrt(2 * (material.moduli.lambda + 2 * material.moduli.mu) / material.density) / edge;
  }
  [[nodiscard]] Scene scene(Integrator integrator, double dt) const {
    Body body = box_body({{1, 1, 1}, edge}, Discretization::hex8full, material);
    body.fixed.push_back({all_nodes(), {false, true, true}});
    body.fixed.push_back({face(0, 0), {true, true, true}});
    AffineField stretch;
    stretch.linear[0] = {kStretch, 0, 0};
    body.initial.push_back({all_nodes(), {}, stretch});
    Scene scene;
    scene.integrator = integrator;
    scene.bodies = {body};
    scene.dt = dt;
    return scene;
  }
  /// Displacement of the free face over that at the start, at rest there.
  [[nodiscard]] double exact(double t) const {
    const double k = material.damping / 2, fast = std::sqrt(omega() * omega() - k * k);
    return std::exp(-k * t) * (std::cos(fast * t) + k / fast * std::sin(fast * t));
  }
};

std::size_t free_node(const Simulation& sim) {
  const auto& rest = sim.model().bodies[0].rest;
  return static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), [](const Vec3d& x) { return x[0] > 0.099; }) -
                                  rest.begin());
}

double displacement(const Simulation& sim) { return sim.displacements(0)[free_node(sim)][0] / (kStretch * 0.1); }

TEST(EveryIntegrator, ConvergesAsItSays) {
  Oscillator o;
  o.material.damping = 0.3 * o.omega();
  const double end = 1.5 * 2 * M_PI / o.omega();
  for (const Integrator integrator : all_integrators()) {
    const IntegratorInfo& info = integrator_info(integrator);
    double before = 0;
    for (const int steps : {240, 480, 960}) {
      auto sim = simulate(o.scene(integrator, end / steps), "cpu:double");
      sim->advance(steps);
      const double error = std::abs(displacement(*sim) - o.exact(end));
      if (before > 0)
        check(std::string(info.word) + " order of convergence less its own", std::log2(before / error) - info.order, 0.1);
      before = error;
    }
  }
}

/// What grows by a given factor per step in one oscillator does so in a simulation.
TEST(EveryIntegrator, ForwardEulerGrowsByItsAmplification) {
  const Oscillator o;
  for (const double turn : {0.01, 0.1}) {  // h omega
    const int steps = 100;
    auto sim = simulate(o.scene(Integrator::forward_euler, turn / o.omega()), "cpu:double");
    sim->advance(steps);
    const double v = sim->velocities(0)[free_node(*sim)][0] / (kStretch * 0.1);
    const double grown = std::hypot(displacement(*sim), v / o.omega());
    check_relative("amplitude after 100 steps of h omega = " + std::to_string(turn), grown,
                   std::pow(1 + turn * turn, steps / 2.0), 1e-6);
  }
}

/// Damped, it has a stable step, c / omega^2, which an automatic one takes; undamped, it says that it has none.
TEST(EveryIntegrator, ForwardEulerTakesTheStepOfItsDamping) {
  Oscillator o;
  Scene scene = o.scene(Integrator::forward_euler, 0);
  const std::string refused = test::error_of([&] { (void)simulate(scene, "cpu"); });
  EXPECT_NE(refused.find("no step is stable with the integrator forward-euler"), std::string::npos) << refused;
  o.material.damping = 0.3 * o.omega();
  scene = o.scene(Integrator::forward_euler, 0);
  auto sim = simulate(scene, "cpu:double");
  check_relative("stable step [s]", sim->stable_dt(), 0.3 / o.omega(), 1e-4);
  EXPECT_EQ(sim->dt(), 0.9 * sim->stable_dt());
  sim->advance(5000);
  EXPECT_LT(std::abs(displacement(*sim)), 0.01);
  scene.dt = 1.1 * 0.3 / o.omega();
  auto grows = simulate(scene, "cpu:double");
  grows->advance(5000);
  EXPECT_GT(std::abs(displacement(*grows)), 100);
}

/// The last part of a step in every integrator: what it does with velocities at the start, gravity and a load.
TEST_P(Integrators, FallAsFreeBodies) {
  for (const Integrator integrator : all_integrators()) {
    Scene scene;
    scene.integrator = integrator;
    Body body = box_body({{2, 2, 2}, 0.05}, Discretization::tet4, material_young(Law::neo_hookean, 3000, 0.3));
    body.velocity = {0.3, 0, 0};
    scene.bodies = {body};
    scene.gravity = {0, 0, -9.81};
    scene.dt = 1e-4;
    auto sim = simulate(scene, GetParam());
    sim->advance(1000);
    const IntegratorInfo& info = integrator_info(integrator);
    const Vec3d u = sim->displacements(0)[3];
    // One of first order has lost g h t / 2.
    const double fallen = 9.81 / 2 * (0.01 - (info.order == 1 ? 1e-5 : 0));
    check_relative(std::string(info.word) + " moved [m]", u[0], 0.03, bound(2e-5, 1e-9));
    check_relative(std::string(info.word) + " fallen [m]", -u[2], fallen,
                   bound(info.keeps_increment ? 2e-5 : 3e-3, 1e-9));  // the others lose small increments in float
  }
}

PLIANT_ON_BACKENDS(Integrators);

}  // namespace
}  // namespace pliant::physics
