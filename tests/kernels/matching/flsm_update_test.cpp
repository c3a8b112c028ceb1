// flsm_update: kernel and twin give the same bits; in double, the formula of the update by hand.
#include <limits>

#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmUpdate : public FlsmTwinTest {};

TEST_F(FlsmUpdate, TwinGivesTheSameBits) {
  for (const int has_load : {0, 1}) {
    compare([has_load](const FlsmData& d, int width) { return flsm_update_case(d, width, has_load); },
            4200 + static_cast<std::uint32_t>(has_load) * 200);
  }
}

/// Nodes of a lattice as flsm_update sees them: slot node_base + i, mass and decay, no floor.
FlsmData update_data(Random& random, const FlsmLattice& lattice) {
  FlsmData d = goal_data(random, lattice);
  d.node_base = 32;
  d.fault_base = 16;
  d.batch = 1;
  d.substeps = 3;
  const std::size_t slots = d.count + static_cast<std::size_t>(d.node_base);
  d.node_u = random.reals(4 * slots, Data::large, 0.01);
  d.node_w = random.reals(4 * slots, Data::large, 1e-3);
  d.node_load = random.reals(4 * slots, Data::large, 2);
  for (std::size_t s = 0; s < slots; ++s) {
    const bool node = s >= 32 && s < 32 + static_cast<std::size_t>(lattice.nodes());
    d.node_u[4 * s + 3] = node ? 1 / random.uniform(0.01, 0.1) : 0;
    d.node_w[4 * s + 3] = random.uniform(0.9, 1);
  }
  d.reference = {0.002, -0.003, 0.001, 0, 9, 9, 9, 9};
  d.alpha = {0.1, 0.7, 0.3};
  d.fault = random.faults(d.count + 16);
  d.step_params = {1e-3, 0.3, -9.81, 2, 0, 0, 1, 0};
  return d;
}

TEST(FlsmUpdateOracle, IsTheFormulaWithAGoal) {
  Random random(9);
  for (const FlsmLattice& lattice : lattices(random)) {
    for (const int has_load : {0, 1}) {
      const FlsmData d = update_data(random, lattice);
      const KernelCase test = flsm_update_case(d, lattice.width(), has_load);
      const Reals u = run_in_double(test, "node_u"), w = run_in_double(test, "node_w");
      const double h = d.substeps * d.step_params[0];
      for (int i = 0; i < lattice.nodes(); ++i) {
        const std::size_t at = 4 * static_cast<std::size_t>(d.node_base + i);
        const Vector3d from = vector_at(d.node_u, at), before = vector_at(d.node_w, at);
        const double inverse_mass = d.node_u[at + 3], decay = d.node_w[at + 3];
        // decay = (1 - k) / (1 + k), so h^2 / (1 + k) = h^2 (1 + decay) / 2
        const double k = (1 - decay) / (1 + decay), b = h * h / (1 + k);
        const Vector3d load = has_load != 0 ? vector_at(d.node_load, at) : Vector3d::Zero();
        const Vector3d push = b * (inverse_mass * load + vector_at(d.step_params, 1));
        const Vector3d step =
            decay * before + 0.7 * (mean_goal(lattice, d.regions, i) - (from - vector_at(d.reference, 0))) + push;
        const std::string what = "node " + std::to_string(i);
        expect_near(step, w, at, 1e-14, what + ", increment");
        expect_near(from + step, u, at, 1e-14, what + ", displacement");
        EXPECT_EQ(u[at + 3], inverse_mass);
        EXPECT_EQ(w[at + 3], decay);
      }
    }
  }
}

TEST(FlsmUpdateOracle, LeavesNodesWithoutInverseMassAndOtherSlots) {
  Random random(10);
  const FlsmLattice lattice(random, {6, 4, 4}, 0.1, 2);
  FlsmData d = update_data(random, lattice);
  const std::size_t fixed = 4 * static_cast<std::size_t>(d.node_base + 7);
  d.node_u[fixed + 3] = 0;
  const Reals u = run_in_double(flsm_update_case(d, 2, 1), "node_u"), w = run_in_double(flsm_update_case(d, 2, 1), "node_w");
  int stayed = 0;
  for (std::size_t at = 0; at < u.size(); at += 4) {
    if (d.node_u[at + 3] > 0) {
      EXPECT_NE(u[at], d.node_u[at]);
      continue;
    }
    ++stayed;
    expect_near(vector_at(d.node_u, at), u, at, 0, "slot " + std::to_string(at / 4));
    const bool in_launch = at / 4 >= 32;
    expect_near(in_launch ? Vector3d(0, 0, 0) : vector_at(d.node_w, at), w, at, 0,
                "increment of slot " + std::to_string(at / 4));
  }
  EXPECT_GT(stayed, 33);
}

TEST(FlsmUpdateOracle, DropsSmallIncrementsAndRoundsSmallDisplacements) {
  const double fine = std::ldexp(1.0, -18), grid = std::ldexp(fine, -22), still = 1e-10;
  Random random(11);
  const FlsmLattice lattice(random, {4, 4, 2}, 0, 1);
  FlsmData d = update_data(random, lattice);
  d.exact = false;
  d.bars.assign(d.bars.size(), 0);
  d.regions.assign(d.regions.size(), 0);
  d.step_params = {1e-3, 0, 0, 0, still, fine, 0, 0};
  for (std::size_t at = 128; at < d.node_u.size(); ++at) {
    if (at % 4 == 3) {
      d.node_w[at] = 1;
    } else {
      d.node_u[at] = d.node_w[at] = 0;
    }
  }
  d.node_w[128] = 0.9 * still;
  d.node_w[129] = -1000.6 * grid;
  d.node_w[130] = 1.25 * fine + 0.25 * grid;
  d.alpha[1] = 0;
  d.reference.assign(8, 0);
  const Reals u = run_in_float(flsm_update_case(d, 1, 0), "node_u"), w = run_in_float(flsm_update_case(d, 1, 0), "node_w");
  EXPECT_EQ(w[128], 0);
  EXPECT_EQ(u[128], 0);
  EXPECT_EQ(w[129], static_cast<float>(d.node_w[129]));
  EXPECT_EQ(u[129], -1001 * grid);
  EXPECT_EQ(u[130], static_cast<float>(d.node_w[130]));
}

std::vector<std::int32_t> faults_of(const FlsmData& d, int width) {
  RefOptions options;
  options.threads = 1;
  const auto backend = make_ref_backend(options);
  const auto all = run_for_bits(*backend, flsm_update_case(d, width, 1));
  const auto& bits = all[static_cast<std::size_t>(flsm_update_case(d, width, 1).program().find("fault"))];
  return {bits.begin(), bits.end()};
}

TEST(FlsmUpdateOracle, MarksTheFirstStepOfANodeThatIsNotFinite) {
  Random random(12);
  const FlsmLattice lattice(random, {6, 4, 4}, 0.1, 2);
  FlsmData d = update_data(random, lattice);
  d.exact = false;
  const auto component = [&](int node, std::size_t c) { return 4 * static_cast<std::size_t>(d.node_base + node) + c; };
  d.node_load[component(3, 0)] = std::numeric_limits<double>::quiet_NaN();
  d.node_load[component(20, 1)] = std::numeric_limits<double>::infinity();
  d.node_u[component(21, 2)] = -std::numeric_limits<double>::infinity();
  d.node_load[component(22, 2)] = std::numeric_limits<double>::quiet_NaN();
  Ints expected = d.fault;
  expected[16 + 22] = d.fault[16 + 22] = 1;  // seen before
  d.fault[16 + 3] = d.fault[16 + 20] = d.fault[16 + 21] = 0;
  for (const std::size_t node : {3U, 20U, 21U}) expected[16 + node] = test_step + 1;
  EXPECT_EQ(faults_of(d, 2), expected);
}

}  // namespace
}  // namespace pliant::kernel_test
