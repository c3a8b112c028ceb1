// flsm_goal: kernel and twin give the same bits; in double, the mean over the regions that hold a node, and the goal before.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmGoal : public FlsmTwinTest {};

TEST_F(FlsmGoal, TwinGivesTheSameBits) { compare(flsm_goal_case, 3800); }

TEST(FlsmGoalOracle, IsTheMeanOfTheRegionsAndKeepsTheOneBefore) {
  Random random(8);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = goal_data(random, lattice);
    ASSERT_EQ(lattice.has_holes(), d.missing_of.size() > 100) << "holes without a list, or a list without holes";
    d.region_base = 32;  // the interface is a part of the nodes
    d.count = 48;
    d.goals = random.reals(8 * d.count, Data::large, 0.01);
    d.reference = {0.5, -0.25, 0.125, 0, 0.25, 1, -1, 0};
    const Vector3d back = vector_at(d.reference, 4) - vector_at(d.reference, 0);
    const Reals goals = run_in_double(flsm_goal_case(d, lattice.width()), "flsm_goals");
    for (std::size_t i = 0; i < d.count; ++i) {
      const int node = static_cast<int>(i) + d.region_base;
      expect_near(mean_goal(lattice, d.regions, node), goals, 8 * i, 1e-14, "goal of node " + std::to_string(node));
      expect_near(vector_at(d.goals, 8 * i) + back, goals, 8 * i + 4, 1e-15, "the goal before of node " + std::to_string(node));
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
