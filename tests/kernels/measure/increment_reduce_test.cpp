// increment_reduce: kernel and twin give the same bits, and find the largest component.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class IncrementReduce : public TwinTest {};

TEST_F(IncrementReduce, TwinGivesTheSameBits) {
  std::uint32_t seed = 1250;
  for (const int texels : {16, 256, 5008}) {
    for (const Data data : all_data) {
      Random random(seed++);
      KernelCase test("increment_reduce", {}, Shape::items, 256);
      test.reals("node_w", random.reals(4 * static_cast<std::size_t>(texels), data, 1))
          .reals("increment_summary", Reals(256, 7));
      test.integer(texels);
      expect_same_bits(test, std::to_string(texels) + " texels");
    }
  }
}

/// Of x, y and z, with either sign; the fourth number of a texel is none, and infinite where one of them is no number.
TEST(IncrementReduceOracle, IsTheLargestComponent) {
  Reals w(4 * 1024, 0.0);
  w[4 * 5] = 0.25;
  w[4 * (5 + 256) + 1] = -0.5;
  w[4 * (6 + 768) + 2] = 0.125;
  w[4 * 7 + 3] = 9;
  w[4 * 8] = std::numeric_limits<double>::quiet_NaN();
  KernelCase test("increment_reduce", {}, Shape::items, 256);
  test.exact("node_w", w).exact("increment_summary", Reals(256, 7)).integer(1024);
  Reals expected(256, 0.0);
  expected[5] = 0.5;
  expected[6] = 0.125;
  expected[8] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(run_in_double(test, "increment_summary"), expected);
}

}  // namespace
}  // namespace pliant::kernel_test
