// flsm_bar: kernel and twin give the same bits; in double, sums over the nodes of a bar.
#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmBar : public FlsmTwinTest {};

TEST_F(FlsmBar, TwinGivesTheSameBits) {
  for (const int relative : {0, 1}) {
    compare([relative](const FlsmData& d, int width) { return flsm_bar_case(d, width, relative); },
            3000 + static_cast<std::uint32_t>(relative) * 10000);
  }
}

TEST(FlsmBarOracle, SumsTheNodesOfABar) {
  Random random(3);
  for (const FlsmLattice& lattice : lattices(random)) {
    const FlsmData d = lattice.data();
    for (const int relative : {0, 1}) {
      FlsmLattice moved = lattice;
      if (relative != 0) moved.set_u([&](int i) -> Vector3d { return lattice.u(i) - lattice.u(0); });
      const Reals bars = run_in_double(flsm_bar_case(d, lattice.width(), relative), "flsm_bars");
      const Reals expected = moved.moments(false, 8);
      for (std::size_t i = 0; i < d.count; ++i) {
        for (const std::size_t block : {0U, 4U}) {
          expect_near(vector_at(expected, 8 * i + block), bars, 8 * i + block, 1e-12, "bar of region " + std::to_string(i));
        }
      }
    }
  }
}

TEST(FlsmBarOracle, KeepsTheReferenceAndTheOneBefore) {
  Random random(5);
  FlsmData d = FlsmLattice(random, {5, 4, 3}, 0.1, 2).data();
  d.reference = {1, 2, 3, 4, 5, 6, 7, 8};
  const Reals kept = run_in_double(flsm_bar_case(d, 2, 0), "flsm_reference"),
              moved = run_in_double(flsm_bar_case(d, 2, 1), "flsm_reference");
  const std::size_t first = 4 * static_cast<std::size_t>(d.slot[0]);
  EXPECT_EQ(kept, d.reference);
  EXPECT_EQ(moved, (Reals{d.node_u[first], d.node_u[first + 1], d.node_u[first + 2], d.node_u[first + 3], 1, 2, 3, 4}));
}

TEST(FlsmBarOracle, IsZeroAtRest) {
  Random random(4);
  FlsmData d = FlsmLattice(random, {5, 4, 3}, 0.1, 2).data();
  d.exact = false;
  d.node_u.assign(d.node_u.size(), 0);
  for (const double b : run_in_float(flsm_bar_case(d, 2, 1), "flsm_bars")) EXPECT_EQ(b, 0);
}

}  // namespace
}  // namespace pliant::kernel_test
