// flsm_plate: kernel and twin give the same bits; in double, sums over the nodes of a plate.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmPlate : public FlsmTwinTest {};

TEST_F(FlsmPlate, TwinGivesTheSameBits) { compare(flsm_plate_case, 3200); }

TEST(FlsmPlateOracle, SumsTheNodesOfAPlate) {
  Random random(5);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = lattice.data();
    d.bars = lattice.moments(false, 8);
    const Reals plates = run_in_double(flsm_plate_case(d, lattice.width()), "flsm_plates");
    const Reals expected = lattice.moments(true, PLIANT_FLSM_RECORD);
    for (std::size_t i = 0; i < d.count; ++i) {
      for (const std::size_t block : {0U, 4U, 8U, 12U}) {
        const std::size_t at = PLIANT_FLSM_RECORD * i + block;
        expect_near(vector_at(expected, at), plates, at, 1e-11, "plate of region " + std::to_string(i));
      }
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
