// limit_fma: kernel and twin give the same bits; in double, the chains follow their closed form.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class LimitFma : public TwinTest {};

TEST_F(LimitFma, TwinGivesTheSameBits) {
  std::uint32_t seed = 1400;
  for (const Data data : all_data) {
    Random random(seed++);
    KernelCase test("limit_fma", {}, Shape::lanes, 2064);
    test.reals("a", random.reals(2064, data, 1)).real(0.5);
    expect_same_bits(test, name_of(data));
  }
}

TEST(LimitFmaOracle, ChainsConvergeToTheirFixedPoint) {
  KernelCase test("limit_fma", {}, Shape::lanes, 16);
  test.exact("a", Reals(16, 3.0)).exact(0.5);
  for (const double a : run_in_double(test, "a")) EXPECT_NEAR(a, 8 * 6, 1e-12);  // c = c / 2 + 3 tends to 6, eight times
}

}  // namespace
}  // namespace pliant::kernel_test
