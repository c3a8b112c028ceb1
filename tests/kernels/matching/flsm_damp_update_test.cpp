// flsm_damp_update: kernel and twin give the same bits; in double, the formulas of damping and of the reaction by hand, and a
// rigid motion that damping leaves alone.
#include "kernels/matching/flsm_damp_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmDampUpdate : public FlsmTwinTest {};

TEST_F(FlsmDampUpdate, TwinGivesTheSameBits) {
  std::uint32_t seed = 5600;
  for (const int reaction : {0, 1}) {
    for (const int substeps : {1, 3}) {
      compare(
          [&](FlsmData d, int width) {
            d.substeps = substeps;
            return flsm_damp_update_case(d, width, reaction);
          },
          seed);
      seed += 100;
    }
  }
}

/// Increments of nodes whose last part is the interface; a few have no inverse mass.
FlsmData update_data(Random& random, const FlsmLattice& lattice, int substeps) {
  FlsmData d = goal_data(random, lattice);
  d.rates = d.regions;
  d.node_w = random.reals(4 * d.count, Data::large, 0.02);
  d.node_u = random.reals(4 * d.count, Data::large, 0.02);
  for (int i = 0; i < static_cast<int>(d.count); ++i) {
    const bool moves = i < lattice.nodes() && i % 7 != 3;
    d.node_u[4 * static_cast<std::size_t>(d.slot[static_cast<std::size_t>(i)]) + 3] = moves ? random.uniform(10, 100) : 0;
  }
  d.damping = 0.3;
  d.substeps = substeps;
  d.interface_base = 2 * lattice.nodes() / 3;
  return d;
}

TEST(FlsmDampUpdateOracle, IsTheFormulaWithTheMeanOfTheRegions) {
  Random random(34);
  for (const FlsmLattice& lattice : lattices(random)) {
    for (const int substeps : {1, 3}) {
      for (const int reaction : {0, 1}) {
        const FlsmData d = update_data(random, lattice, substeps);
        const Reals w = run_in_double(flsm_damp_update_case(d, lattice.width(), reaction), "node_w");
        for (int i = 0; i < lattice.nodes(); ++i) {
          const std::size_t at = 4 * static_cast<std::size_t>(d.slot[static_cast<std::size_t>(i)]);
          if (d.node_u[at + 3] == 0) continue;
          const Vector3d before = vector_at(d.node_w, at);
          const int steps = i >= d.interface_base ? substeps : 1;
          const Vector3d rigid = mean_goal(lattice, d.rates, i) / steps;
          const Vector3d after = reaction != 0 ? Vector3d(before - rigid) : Vector3d(0.7 * before + 0.3 * rigid);
          expect_near(after, w, at, 1e-14, "node " + std::to_string(i));
        }
      }
    }
  }
}

TEST(FlsmDampUpdateOracle, LeavesNodesWithoutInverseMassAndTheDecay) {
  Random random(35);
  const FlsmLattice lattice(random, {6, 4, 4}, 0.1, 2);
  for (const int reaction : {0, 1}) {
    const FlsmData d = update_data(random, lattice, 3);
    const Reals w = run_in_double(flsm_damp_update_case(d, 2, reaction), "node_w");
    int stayed = 0;
    for (std::size_t at = 0; at < w.size(); at += 4) {
      EXPECT_EQ(w[at + 3], d.node_w[at + 3]);
      if (d.node_u[at + 3] > 0) {
        EXPECT_NE(w[at], d.node_w[at]);
        continue;
      }
      ++stayed;
      expect_near(vector_at(d.node_w, at), w, at, 0, "slot " + std::to_string(at / 4));
    }
    EXPECT_GT(stayed, 10);
  }
}

/// The rates come from flsm_damp_region, to which interface nodes give increments `substeps` times shorter, with weights as
/// much larger.
FlsmData rigid_data(const FlsmLattice& lattice, const Matrix3d& turn, int substeps) {
  FlsmData d = damp_region_data(lattice, std::vector<Matrix3d>(static_cast<std::size_t>(lattice.nodes()), turn));
  d.substeps = substeps;
  d.interface_base = lattice.nodes() / 2;
  const auto shorter = [&](int i) { return i >= d.interface_base ? substeps : 1; };
  std::vector<double> times(d.count, 1);  // by slot
  for (int i = 0; i < lattice.nodes(); ++i) times[static_cast<std::size_t>(d.slot[static_cast<std::size_t>(i)])] = shorter(i);
  for (std::size_t at = 0; at < d.node_w.size(); ++at) {
    if (at % 4 != 3) d.node_w[at] /= times[at / 4];
  }
  for (std::size_t e = 0; e < d.missing_factor.size(); ++e)
    d.missing_factor[e] *= times[static_cast<std::size_t>(d.missing[e / 4])];
  d.rates = run_in_double(flsm_damp_region_case(d, lattice.width()), "flsm_rates");
  for (int i = 0; i < lattice.nodes(); ++i) {
    const GoalSums sums = goal_sums(lattice, d.rates, i, true);
    put(d.bars, 8 * static_cast<std::size_t>(i), sums.t);
    put(d.bars, 8 * static_cast<std::size_t>(i) + 4, sums.x);
  }
  for (std::size_t at = 3; at < d.node_u.size(); at += 4) d.node_u[at] = 20;
  return d;
}

TEST(FlsmDampUpdateOracle, ARigidMotionStaysAndTheReactionTakesAllOfIt) {
  Random random(36);
  for (FlsmLattice& lattice : lattices(random)) {
    for (const int substeps : {1, 3}) {
      const RigidField field = random_field(random);
      lattice.set_u(field);
      FlsmData d = rigid_data(lattice, field.turn, substeps);
      d.damping = 1;
      const Reals damped = run_in_double(flsm_damp_update_case(d, lattice.width(), 0), "node_w"),
                  taken = run_in_double(flsm_damp_update_case(d, lattice.width(), 1), "node_w");
      for (int i = 0; i < lattice.nodes(); ++i) {
        const std::size_t at = 4 * static_cast<std::size_t>(d.slot[static_cast<std::size_t>(i)]);
        ASSERT_GT(vector_at(d.node_w, at).norm(), 1e-6);
        expect_near(vector_at(d.node_w, at), damped, at, 1e-15, "node " + std::to_string(i) + ", damped");
        expect_near(Vector3d::Zero(), taken, at, 1e-15, "node " + std::to_string(i) + ", taken");
      }
    }
  }
}

TEST(FlsmDampUpdateOracle, WithoutDampingNothingChanges) {
  Random random(37);
  const FlsmLattice lattice(random, {6, 4, 4}, 0.1, 2);
  FlsmData d = update_data(random, lattice, 3);
  d.damping = 0;
  EXPECT_EQ(run_in_double(flsm_damp_update_case(d, 2, 0), "node_w"), d.node_w);
}

}  // namespace
}  // namespace pliant::kernel_test
