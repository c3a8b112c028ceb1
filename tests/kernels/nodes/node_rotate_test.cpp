// node_rotate: kernel and twin give the same bits; in double, the displacement is that of the rotation.
#include "integrators/integrator.h"
#include "kernels/random_data.h"

namespace pliant::kernel_test::rotate_test {
namespace {

class NodeRotate : public TwinTest {};

KernelCase make_case(Integrator integrator, std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t nodes = count + 100;
  constexpr int curves = 4, rows = test_step + 2;
  KernelCase test("node_rotate", {{"INTEGRATOR", static_cast<int>(integrator)}}, Shape::items, count);
  test.reals("node_u", random.reals(4 * nodes, data, 0.01))
      .reals("node_w", random.reals(4 * nodes, data, 0.01))
      .ints("rotated_node", random.distinct(count, nodes))
      .ints("rotated_axes", random.ints(count, 0, 7))
      .ints("rotated_curve", random.ints(3 * count, 0, curves - 2))
      .reals("rotated_cosine", random.reals(4 * count, data, 0.02))
      .reals("rotated_sine", random.reals(4 * count, data, 0.02))
      .reals("curve_value", random.reals(rows * curves, data, 1))
      .integer(curves)
      .step();
  return test;
}

TEST_F(NodeRotate, TwinGivesTheSameBits) {
  std::uint32_t seed = 860;
  for (const Integrator integrator : all_integrators()) {
    for (const std::size_t count : {1U, 37U, 1500U}) {
      for (const Data data : all_data) expect_same_bits(make_case(integrator, count, data, seed++), name_of(data));
    }
  }
}

/// The point [3, 2, 0] turns about the z axis from 90 to 180 degrees; its z component is another's. Rows 2 and 3 count.
TEST(NodeRotateOracle, MovesOnACircle) {
  for (const Integrator integrator : all_integrators()) {
    KernelCase test("node_rotate", {{"INTEGRATOR", static_cast<int>(integrator)}}, Shape::items, 1);
    test.exact("node_u", Reals(8, 9)).exact("node_w", Reals(8, 9)).ints("rotated_node", {1}).ints("rotated_axes", {3});
    test.ints("rotated_curve", {1, 1, 0}).exact("rotated_cosine", {3, 2, 0, 0}).exact("rotated_sine", {-2, 3, 0, 0});
    test.exact("curve_value", {7, 7, 7, 7, 7, 7, 7, -1, 1, 7, -2, 0}).integer(3).step();
    EXPECT_EQ(run_in_double(test, "node_u"), (Reals{9, 9, 9, 9, -6, -4, 9, 9}));
    EXPECT_EQ(run_in_double(test, "node_w"),
              integrator == Integrator::textbook ? (Reals{9, 9, 9, 9, -5, 1, 9, 9}) : (Reals{9, 9, 9, 9, -1, -5, 9, 9}));
  }
}

}  // namespace
}  // namespace pliant::kernel_test::rotate_test
