// surface_position: kernel and twin give the same bits; in double, an affine motion is interpolated exactly.
#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test::surface_test {
namespace {

class SurfacePosition : public TwinTest {};

KernelCase make_case(int width, std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr std::size_t nodes = 300;
  KernelCase test("surface_position", {{"WIDTH", width}}, Shape::lanes, count);
  test.reals("node_u", random.reals(4 * nodes, data, 0.01))
      .reals("surface_rest", random.reals(4 * count, data, 0.1))
      .ints("surface_node", random.ints(static_cast<std::size_t>(width) * count, 0, nodes - 1))
      .reals("surface_weight", random.reals(static_cast<std::size_t>(width) * count, data, 1))
      .reals("surface_x", random.reals(4 * count, Data::large, 1));
  return test;
}

TEST_F(SurfacePosition, TwinGivesTheSameBits) {
  std::uint32_t seed = 1000;
  for (const int width : {1, 8}) {
    for (const std::size_t count : {16U, 80U, 2064U}) {
      for (const Data data : all_data) expect_same_bits(make_case(width, count, data, seed++), name_of(data));
    }
  }
}

TEST(SurfacePositionOracle, AddsTheWeightedDisplacement) {
  Ints nodes(8 * 16, 0);
  Reals weights(8 * 16, 0.0);
  for (std::size_t a = 0; a < 8; ++a) {
    nodes[a * 16 + 5] = static_cast<std::int32_t>(a);
    weights[a * 16 + 5] = static_cast<double>(a + 1) / 36;
  }
  Reals u(32), rest(64, 1.0), expected{1, 1, 1};
  for (std::size_t i = 0; i < 32; ++i) u[i] = 0.01 * static_cast<double>(i * i % 7);
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t c = 0; c < 3; ++c) expected[c] += static_cast<double>(a + 1) / 36 * u[4 * a + c];
  }
  KernelCase test("surface_position", {{"WIDTH", 8}}, Shape::lanes, 16);
  test.exact("node_u", u).exact("surface_rest", rest).ints("surface_node", nodes).exact("surface_weight", weights);
  test.exact("surface_x", Reals(64));
  const Reals x = run_in_double(test, "surface_x");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(x[4 * 5 + c], expected[c], 1e-15);
  EXPECT_EQ(x[4 * 5 + 3], 1);
}

}  // namespace
}  // namespace pliant::kernel_test::surface_test
