// node_prescribe: kernel and twin give the same bits; in double, the prescribed motion is target times curve.
#include "integrators/integrator.h"
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class NodePrescribe : public TwinTest {};

KernelCase make_case(Integrator integrator, std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  const std::size_t nodes = count + 100;
  constexpr int curves = 3, rows = test_step + 2;
  KernelCase test("node_prescribe", {{"INTEGRATOR", static_cast<int>(integrator)}}, Shape::items, count);
  test.reals("node_u", random.reals(4 * nodes, data, 0.01))
      .reals("node_w", random.reals(4 * nodes, data, 0.01))
      .ints("prescribed_node", random.distinct(count, nodes))
      .ints("prescribed_axes", random.ints(count, 0, 7))
      .ints("prescribed_curve", random.ints(3 * count, 0, curves - 1))
      .reals("prescribed_target", random.reals(4 * count, data, 0.02))
      .reals("curve_value", random.reals(rows * curves, data, 1))
      .integer(curves)
      .step();
  return test;
}

TEST_F(NodePrescribe, TwinGivesTheSameBits) {
  std::uint32_t seed = 800;
  for (const Integrator integrator : all_integrators()) {
    for (const std::size_t count : {1U, 37U, 1500U}) {
      for (const Data data : all_data) expect_same_bits(make_case(integrator, count, data, seed++), name_of(data));
    }
  }
}

TEST(NodePrescribeOracle, FollowsTheCurve) {
  for (const Integrator integrator : all_integrators()) {
    KernelCase test("node_prescribe", {{"INTEGRATOR", static_cast<int>(integrator)}}, Shape::items, 1);
    test.exact("node_u", {9, 9, 9, 9, 9, 9, 9, 9}).exact("node_w", {9, 9, 9, 9, 9, 9, 9, 9}).ints("prescribed_node", {1});
    test.ints("prescribed_axes", {1 + 4}).ints("prescribed_curve", {0, 0, 1}).exact("prescribed_target", {2, 3, 5, 0});
    test.exact("curve_value", {0, 0, 0, 0, 0.25, 0.5, 0.5, 1}).integer(2).step();  // rows 2 and 3 count
    const Reals u = run_in_double(test, "node_u"), w = run_in_double(test, "node_w");
    EXPECT_EQ(u, (Reals{9, 9, 9, 9, 1, 9, 5, 9}));
    EXPECT_EQ(w, (Reals{9, 9, 9, 9, 0.5, 9, 2.5, 9}));
  }
}

}  // namespace
}  // namespace pliant::kernel_test
