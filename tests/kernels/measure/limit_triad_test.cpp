// limit_triad: kernel and twin give the same bits.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class LimitTriad : public TwinTest {};

TEST_F(LimitTriad, TwinGivesTheSameBits) {
  std::uint32_t seed = 1300;
  for (const Data data : all_data) {
    Random random(seed++);
    KernelCase test("limit_triad", {}, Shape::lanes, 2064);
    test.reals("a", random.reals(2064, data, 1))
        .reals("b", random.reals(2064, data, 1))
        .reals("c", random.reals(2064, data, 1))
        .real(0.3);
    expect_same_bits(test, name_of(data));
  }
}

TEST(LimitTriadOracle, AddsAMultiple) {
  KernelCase test("limit_triad", {}, Shape::lanes, 16);
  test.exact("a", Reals(16)).exact("b", Reals(16, 2.0)).exact("c", Reals(16, 4.0)).exact(0.25);
  for (const double a : run_in_double(test, "a")) EXPECT_EQ(a, 3);
}

}  // namespace
}  // namespace pliant::kernel_test
