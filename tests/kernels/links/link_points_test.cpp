// link_points: kernel and twin give the same bits; in double, a point has the weighted mean of its nodes.
#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test {
namespace {

class LinkPointsKernel : public TwinTest {};

KernelCase link_points_case(std::size_t count, int viscous, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int nodes = 300;
  Ints offset{0};
  for (std::size_t tile = 0; tile < count / PLIANT_TILE; ++tile) offset.push_back(offset.back() + random.integer(0, 8));
  const std::size_t entries = (static_cast<std::size_t>(offset.back()) + 1) * PLIANT_TILE;
  KernelCase test("link_points", {{"VISCOUS", viscous}}, Shape::lanes, count);
  test.reals("node_u", random.reals(4 * nodes, data, 0.1)).reals("node_w", random.reals(4 * nodes, data, 1e-4));
  test.ints("point_offset", offset).ints("point_slot", random.ints(entries, 0, nodes - 1));
  test.reals("point_weight", random.reals(entries, data_for_constants(data), 1));
  test.reals("link_u", Reals(4 * count)).reals("link_w", Reals(4 * count));
  return test;
}

TEST_F(LinkPointsKernel, TwinGivesTheSameBits) {
  std::uint32_t seed = 4100;
  for (const int viscous : {0, 1}) {
    for (const std::size_t count : {16U, 80U, 2064U}) {
      for (const Data data : all_data) expect_same_bits(link_points_case(count, viscous, data, seed++), name_of(data));
    }
  }
}

TEST(LinkPointsOracle, PointHasTheWeightedMeanOfItsNodes) {
  Reals u(12), w(12), weight(32, 0.0);
  for (std::size_t i = 0; i < 12; ++i) u[i] = double(i), w[i] = 100 + double(i);
  Ints slot(32, 0);
  slot[5] = 1, slot[16 + 5] = 2;
  weight[5] = 0.25, weight[16 + 5] = 0.75;
  slot[6] = 2, weight[6] = 1;
  KernelCase test("link_points", {{"VISCOUS", 1}}, Shape::lanes, 16);
  test.exact("node_u", u)
      .exact("node_w", w)
      .ints("point_offset", {0, 2})
      .ints("point_slot", slot)
      .exact("point_weight", weight);
  test.exact("link_u", Reals(64, 7.0)).exact("link_w", Reals(64, 7.0));
  const Reals mean = run_in_double(test, "link_u"), moved = run_in_double(test, "link_w");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(mean[4 * 5 + c], 0.25 * (4 + double(c)) + 0.75 * (8 + double(c)));
    EXPECT_EQ(moved[4 * 5 + c], 100 + mean[4 * 5 + c]);
    EXPECT_EQ(mean[4 * 6 + c], 8 + double(c)) << "a node keeps its bits";
    EXPECT_EQ(mean[4 * 4 + c], 0) << "padding";
  }
}

}  // namespace
}  // namespace pliant::kernel_test
