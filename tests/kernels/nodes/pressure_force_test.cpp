// pressure_force: kernel and twin give the same bits; in double, it is -p times the area vector.
#include "kernels/random_data.h"

namespace pliant::kernel_test::pressure_test {
namespace {

class PressureForce : public TwinTest {};

KernelCase make_case(std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int curves = 4, vertices = 200;
  KernelCase test("pressure_force", {}, Shape::items, count);
  test.reals("surface_x", random.reals(4 * vertices, data, 0.1))
      .ints("pressure_triangle", random.ints(3 * count, 0, vertices - 1))
      .reals("pressure_value", random.reals(count, data, 1000))
      .ints("pressure_curve", random.ints(count, 0, curves - 1))
      .reals("pressure_force", random.reals(4 * count, Data::large, 1))
      .reals("curve_value", random.reals((test_step + 2) * curves, data, 1))
      .integer(curves)
      .step();
  return test;
}

TEST_F(PressureForce, TwinGivesTheSameBits) {
  std::uint32_t seed = 1100;
  for (const std::size_t count : {1U, 37U, 1500U}) {
    for (const Data data : all_data) expect_same_bits(make_case(count, data, seed++), name_of(data));
  }
}

/// A right triangle with legs 2 and 3 in the plane z = 1, its normal along +z: the area is 3, the pressure pushes along -z.
TEST(PressureForceOracle, IsPressureTimesAreaAgainstTheNormal) {
  KernelCase test("pressure_force", {}, Shape::items, 1);
  test.exact("surface_x", {1, 1, 1, 0, 3, 1, 1, 0, 1, 4, 1, 0}).ints("pressure_triangle", {0, 1, 2});
  test.exact("pressure_value", {100}).ints("pressure_curve", {1}).exact("pressure_force", Reals(4, 9));
  test.exact("curve_value", {0, 0, 0, 0, 0, 0.5, 0, 0}).integer(2).step();
  EXPECT_EQ(run_in_double(test, "pressure_force"), (Reals{0, 0, -150, 0}));
}

}  // namespace
}  // namespace pliant::kernel_test::pressure_test
