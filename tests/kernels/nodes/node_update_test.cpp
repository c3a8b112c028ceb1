// node_update: kernel and twin give the same bits; in double, a free oscillator follows its closed form.
#include "kernels/nodes/integrator_oracle.h"
#include "kernels/nodes/update_case.h"

namespace pliant::kernel_test {
namespace {

class NodeUpdate : public TwinTest {};

TEST_F(NodeUpdate, TwinGivesTheSameBits) {
  std::uint32_t seed = 600;
  for (int kind = 0; kind < 4 * integrator_count; ++kind) {
    const Defines defines = update_defines(kind & 1, kind >> 1 & 1, all_integrators()[static_cast<std::size_t>(kind / 4)]);
    for (const std::size_t nodes : {16U, 80U, 2064U}) {
      for (const Data data : all_data) expect_same_bits(node_update_case(defines, nodes, data, seed++), name_of(data));
    }
  }
}

/// Increment and textbook form agree in exact arithmetic, and with the formula of central differences.
TEST(NodeUpdateOracle, IsCentralDifferencesWithDamping) {
  const double h = 1e-3, mass = 0.02, c = 8, load = 0.7, force = 0.25, gravity = -9.81;
  const double u = 0.01, before = 0.008;
  const double k = c * h / 2, decay = (1 - k) / (1 + k);
  // m (u+ - 2 u + u-) / h^2 + m c (u+ - u-) / (2 h) = R - F + m g
  const double expected =
      ((load - force) / mass + gravity + (2 * u - before) / (h * h) + c * before / (2 * h)) / (1 / (h * h) + c / (2 * h));
  for (const Integrator form : {Integrator::increment, Integrator::textbook}) {
    Reals node_u(64, 0.0), node_w(64, 0.0), node_load(64, 0.0), corner_force(48, -0.0);
    node_u[1] = u;
    node_u[3] = 1 / mass;
    node_w[1] = form == Integrator::textbook ? before : u - before;
    node_w[3] = decay;
    node_load[1] = load;
    corner_force[16 + 5] = force;
    Ints index(16, 0);
    index[0] = 5;
    KernelCase test("node_update", update_defines(1, 0, form), Shape::lanes, 16);
    test.exact("node_u", node_u).exact("node_w", node_w).ints("gather_offset", {0, 1}).ints("gather_index", index);
    test.exact("corner_force", corner_force).exact("node_load", node_load).exact("node_force", Reals(64));
    test.exact("step_params", {h, 0, gravity, 0, 0, 0, 0, 0}).integer(0);
    const Reals after = run_in_double(test, "node_u"), w = run_in_double(test, "node_w");
    EXPECT_NEAR(after[1], expected, 1e-14 * std::fabs(expected));
    EXPECT_NEAR(w[1], form == Integrator::textbook ? u : expected - u, 1e-15);
    EXPECT_EQ(after[3], 1 / mass);
    for (std::size_t i = 4; i < 64; ++i) EXPECT_EQ(after[i], 0) << "a slot without a node moved: " << i;
  }
}

/// One node with the force of a spring, in double: what node_u and node_w hold after a step from `at`.
Phase stepped(Integrator integrator, Phase at, double omega2, double c, double h) {
  const double mass = 0.02;
  const IntegratorInfo& info = integrator_info(integrator);
  Reals node_u(64, 0.0), node_w(64, 0.0), node_load(64, 0.0);
  node_u[1] = at.u;
  node_u[3] = 1 / mass;
  node_w[1] = info.first({at.u, at.v, 0, h});
  node_w[3] = info.decay(c * h / 2);
  node_load[1] = -mass * omega2 * at.u;
  KernelCase test("node_update", update_defines(1, 0, integrator), Shape::lanes, 16);
  test.exact("node_u", node_u).exact("node_w", node_w).ints("gather_offset", {0, 0}).ints("gather_index", Ints(16, 0));
  test.exact("corner_force", Reals(48, -0.0)).exact("node_load", node_load).exact("node_force", Reals(64));
  test.exact("step_params", {h, 0, 0, 0, 0, 0, 0, 0}).integer(0);
  const double u = run_in_double(test, "node_u")[1], w = run_in_double(test, "node_w")[1];
  return {u, info.increment(u, w) / h};
}

TEST(NodeUpdateOracle, EveryIntegratorIsTheStepOfATextbook) {
  for (const Integrator integrator : all_integrators()) {
    Phase at{0.01, -0.3}, expected = at;
    const double omega2 = 1600, c = 3, h = 1e-3;
    for (int n = 0; n < 50; ++n) {
      at = stepped(integrator, at, omega2, c, h);
      expected = textbook_step(integrator, expected, omega2, c, h);
      ASSERT_NEAR(at.u, expected.u, 1e-13) << integrator_info(integrator).word << " step " << n;
      ASSERT_NEAR(at.v, expected.v, 1e-9) << integrator_info(integrator).word << " step " << n;
    }
  }
}

/// Without damping the amplitude of an oscillator grows by |1 + i h omega| in every step (Hairer, Norsett and Wanner 1993).
TEST(NodeUpdateOracle, ForwardEulerGrowsByItsAmplification) {
  const double omega = 40;
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    Phase at{0.01, 0.2};
    for (int n = 0; n < 20; ++n) {
      const Phase next = stepped(Integrator::forward_euler, at, omega * omega, 0, h);
      const double ratio = std::hypot(omega * next.u, next.v) / std::hypot(omega * at.u, at.v);
      EXPECT_NEAR(ratio, std::sqrt(1 + h * h * omega * omega), 2e-15);
      at = next;
    }
  }
}

/// An increment below the floor is none, one above it stays as it is.
TEST(NodeUpdateOracle, DropsIncrementsBelowTheFloor) {
  Reals node_u(64, 0.0), node_w(64, 0.0);
  for (const std::size_t i : {0U, 1U}) {
    node_u[4 * i + 3] = 1;
    node_w[4 * i] = i == 0 ? 0.9e-9 : -1.1e-9;
    node_w[4 * i + 3] = 1;
  }
  KernelCase test("node_update", update_defines(0, 0), Shape::lanes, 16);
  test.exact("node_u", node_u).exact("node_w", node_w).ints("gather_offset", {0, 0}).ints("gather_index", Ints(16, 0));
  test.exact("corner_force", Reals(48, -0.0)).exact("node_load", Reals(64)).exact("node_force", Reals(64));
  test.exact("step_params", {1e-3, 0, 0, 0, 1e-9, 0, 0, 0}).integer(0);
  const Reals u = run_in_double(test, "node_u"), w = run_in_double(test, "node_w");
  EXPECT_EQ(w[0], 0);
  EXPECT_EQ(u[0], 0);
  EXPECT_EQ(w[4], -1.1e-9);
  EXPECT_EQ(u[4], -1.1e-9);
}

TEST(NodeUpdateOracle, RoundsSmallDisplacementsToTheGrid) {
  const double fine = std::ldexp(1.0, -18), grid = std::ldexp(fine, -22);
  Reals node_u(64, 0.0), node_w(64, 0.0);
  for (const std::size_t i : {0U, 1U, 2U}) {
    node_u[4 * i + 3] = 1;
    node_w[4 * i + 3] = 1;
  }
  node_w[0] = 5.3 * grid;
  node_w[4] = -1000.6 * grid;
  node_w[8] = 1.25 * fine + 0.25 * grid;  // too large to be rounded
  KernelCase test("node_update", update_defines(0, 0), Shape::lanes, 16);
  test.exact("node_u", node_u).exact("node_w", node_w).ints("gather_offset", {0, 0}).ints("gather_index", Ints(16, 0));
  test.exact("corner_force", Reals(48, -0.0)).exact("node_load", Reals(64)).exact("node_force", Reals(64));
  test.exact("step_params", {1e-3, 0, 0, 0, 0, fine, 0, 0}).integer(0);
  const Reals u = run_in_float(test, "node_u"), w = run_in_float(test, "node_w");
  EXPECT_EQ(u[0], 5 * grid);
  EXPECT_EQ(u[4], -1001 * grid);
  EXPECT_EQ(u[8], static_cast<float>(node_w[8]));
  EXPECT_EQ(w[0], static_cast<float>(node_w[0]));  // the velocity is not rounded
}

}  // namespace
}  // namespace pliant::kernel_test
