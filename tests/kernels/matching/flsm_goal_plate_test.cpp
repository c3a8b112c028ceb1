// flsm_goal_plate: kernel and twin give the same bits; in double, sums over the regions that a node reaches along z.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmGoalPlate : public FlsmTwinTest {};

TEST_F(FlsmGoalPlate, TwinGivesTheSameBits) { compare(flsm_goal_plate_case, 3400); }

TEST(FlsmGoalPlateOracle, SumsTheRegionsAlongZ) {
  Random random(6);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = lattice.data();
    d.regions = random_records(random, lattice, d.count);
    d.plates.assign(d.plates.size(), 99);
    const Reals plates = run_in_double(flsm_goal_plate_case(d, lattice.width()), "flsm_plates");
    for (int i = 0; i < lattice.nodes(); ++i) {
      const GoalSums sums = goal_sums(lattice, d.regions, i, false);
      const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i);
      const std::string what = "node " + std::to_string(i);
      expect_near(sums.t, plates, at, 1e-14, what + ", t");
      expect_near(sums.x, plates, at + 4, 1e-14, what + ", h D e_x");
      expect_near(sums.y, plates, at + 8, 1e-14, what + ", h D e_y");
      expect_near(Vector3d::Zero(), plates, at + 12, 0, what + ", the block without meaning");
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
