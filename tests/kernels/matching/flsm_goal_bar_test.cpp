// flsm_goal_bar: kernel and twin give the same bits; in double, sums over the regions that a node reaches along y, then z.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmGoalBar : public FlsmTwinTest {};

TEST_F(FlsmGoalBar, TwinGivesTheSameBits) { compare(flsm_goal_bar_case, 3600); }

TEST(FlsmGoalBarOracle, SumsTheRegionsAlongYAndZ) {
  Random random(7);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = lattice.data();
    d.regions = random_records(random, lattice, d.count);
    for (int i = 0; i < lattice.nodes(); ++i) {
      const GoalSums sums = goal_sums(lattice, d.regions, i, false);
      const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i);
      put(d.plates, at, sums.t);
      put(d.plates, at + 4, sums.x);
      put(d.plates, at + 8, sums.y);
    }
    const Reals bars = run_in_double(flsm_goal_bar_case(d, lattice.width()), "flsm_bars");
    for (int i = 0; i < lattice.nodes(); ++i) {
      const GoalSums sums = goal_sums(lattice, d.regions, i, true);
      const std::size_t at = 8 * static_cast<std::size_t>(i);
      expect_near(sums.t, bars, at, 1e-13, "node " + std::to_string(i) + ", t");
      expect_near(sums.x, bars, at + 4, 1e-13, "node " + std::to_string(i) + ", h D e_x");
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
