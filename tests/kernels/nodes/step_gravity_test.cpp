// step_gravity: kernel and twin give the same bits; in double, gravity alone is multiplied, by the row of the present step.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class StepGravity : public TwinTest {};

TEST_F(StepGravity, TwinGivesTheSameBits) {
  std::uint32_t seed = 830;
  for (const Data data : all_data) {
    Random random(seed++);
    KernelCase test("step_gravity", {}, Shape::items, 8);
    constexpr int curves = 3, rows = test_step + 2;
    test.reals("step_now", random.reals(8, data, 1))
        .reals("step_params", random.reals(8, data, 10))
        .reals("curve_value", random.reals(rows * curves, data, 1))
        .integer(curves)
        .integer(2)
        .step();
    expect_same_bits(test, name_of(data));
  }
}

TEST(StepGravityOracle, MultipliesGravityByTheCurveOfTheStep) {
  KernelCase test("step_gravity", {}, Shape::items, 8);
  test.exact("step_now", Reals(8, 9)).exact("step_params", {2, 3, 5, 7, 11, 13, 17, 19});
  test.exact("curve_value", {1, 8, 1, 8, 1, 0.5, 1, 8}).integer(2).integer(1).step();  // row 2 counts
  EXPECT_EQ(run_in_double(test, "step_now"), (Reals{2, 1.5, 2.5, 3.5, 11, 13, 17, 19}));
}

}  // namespace
}  // namespace pliant::kernel_test
