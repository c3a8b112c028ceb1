// flsm_bar: kernel and twin give the same bits; in double, sums over the nodes of a bar.
#include "flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmBar : public FlsmTwinTest {};

TEST_F(FlsmBar, TwinGivesTheSameBits) { compare(flsm_bar_case, 3000); }

TEST(FlsmBarOracle, SumsTheNodesOfABar) {
  Random random(3);
  for (const FlsmLattice& lattice : lattices(random)) {
    const FlsmData d = lattice.data();
    const Reals bars = run_in_double(flsm_bar_case(d, lattice.width()), "flsm_bars"), expected = lattice.moments(false, 8);
    for (std::size_t i = 0; i < d.count; ++i) {
      for (const std::size_t block : {0U, 4U}) {
        expect_near(vector_at(expected, 8 * i + block), bars, 8 * i + block, 1e-12, "bar of region " + std::to_string(i));
      }
    }
  }
}

TEST(FlsmBarOracle, IsZeroAtRest) {
  Random random(4);
  FlsmData d = FlsmLattice(random, {5, 4, 3}, 0.1, 2).data();
  d.exact = false;
  d.node_u.assign(d.node_u.size(), 0);
  for (const double b : run_in_float(flsm_bar_case(d, 2), "flsm_bars")) EXPECT_EQ(b, 0);
}

}  // namespace
}  // namespace pliant::kernel_test
