// Central differences in increment form against the textbook form 2 u_n - u_(n-1), in float, after many small steps.
#include "physics/harness.h"

namespace pliant::physics {
namespace {

class Increment : public OnBackend {};

/// A clamped block loaded slowly over 1e5 steps far below the stable one: u_n and u_(n-1) nearly cancel.
std::vector<Vec3d> run(const char* backend, Discretization cut, Integrator integrator) {
  Scene scene;
  Body body = box_body({{2, 1, 1}, 0.05}, cut, material_young(Law::neo_hookean, 3000, 0.45));
  body.fixed.push_back({face(0, 0), {true, true, true}});
  Force force;
  force.where = face(0, 0.1);
  force.force = {0.2, -0.1, 0.05};
  force.curve = smooth(0.6);
  body.forces = {force};
  scene.bodies = {body};
  scene.dt = 1e-5;
  scene.integrator = integrator;
  SimulationOptions options;
  options.stable_step = false;
  options.batch_steps = 1000;
  auto sim = simulate(scene, backend, options);
  sim->advance(100000);
  EXPECT_FALSE(sim->divergence().has_value());
  return sim->displacements(0);
}

double distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    difference += (eigen(a[n]) - eigen(b[n])).squaredNorm();
    size += eigen(b[n]).squaredNorm();
  }
  return std::sqrt(difference / size);
}

TEST_P(Increment, RoundingAfterAHundredThousandSteps) {
  if (in_double()) GTEST_SKIP() << "the double twin is the reference of this test";
  const bool device = std::string(GetParam()) == "opencl:0";  // small launches take their time there
  for (const Discretization cut : device ? std::vector<Discretization>{Discretization::hex8_bricks}
                                         : std::vector<Discretization>{Discretization::tet4, Discretization::hex8_bricks}) {
    const auto exact = run("cpu:double", cut, Integrator::increment), other = run("cpu:double", cut, Integrator::textbook);
    const std::string name = name_of(cut);
    check(name + " in double the two forms agree", distance(other, exact), 1e-9);
    const double increment = distance(run(GetParam(), cut, Integrator::increment), exact);
    const double textbook = distance(run(GetParam(), cut, Integrator::textbook), exact);
    check(name + " increment form in float", increment, 1e-4);
    std::printf("  %-58s error %10.3e  (%.0f times)\n", (name + " textbook form in float").c_str(), textbook,
                textbook / increment);
    EXPECT_GT(textbook, 10 * increment);
  }
}

PLIANT_ON_BACKENDS(Increment);

}  // namespace
}  // namespace pliant::physics
