// node_load: kernel and twin give the same bits; in double, forces, pressure and corner forces add up.
#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test {
namespace {

class NodeLoad : public TwinTest {};

KernelCase make_case(std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int curves = 4, triangles = 50, corner_tiles = 10;
  Ints offset{0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    for (int list = 0; list < 3; ++list) offset.push_back(offset[offset.size() - 3] + random.integer(0, 4));
  }
  const auto total = [&](std::size_t list) { return static_cast<std::size_t>(offset[3 * count + list]); };
  Ints corner = random.ints(total(2) + 1, 0, corner_tiles - 1);
  for (auto& c : corner) c = c * 3 * PLIANT_TILE + random.integer(0, PLIANT_TILE - 1);
  KernelCase test("node_load", {}, Shape::items, count);
  test.reals("node_load", random.reals(4 * (count + 20), Data::large, 1)).ints("load_node", random.distinct(count, count + 20));
  test.ints("load_offset", offset).reals("load_force", random.reals(4 * (total(0) + 1), data, 1));
  test.ints("load_curve", random.ints(total(0) + 1, 0, curves - 1))
      .ints("load_triangle", random.ints(total(1) + 1, 0, triangles - 1));
  test.reals("load_weight", random.reals(total(1) + 1, data, 1)).ints("load_corner", corner);
  test.reals("pressure_force", random.reals(4 * triangles, data, 1));
  test.reals("corner_force", random.reals(corner_tiles * 3 * PLIANT_TILE, data, 1));
  test.reals("curve_value", random.reals((test_step + 2) * curves, data, 1)).integer(curves).step();
  return test;
}

TEST_F(NodeLoad, TwinGivesTheSameBits) {
  std::uint32_t seed = 900;
  for (const std::size_t count : {1U, 37U, 1500U}) {
    for (const Data data : all_data) expect_same_bits(make_case(count, data, seed++), name_of(data));
  }
}

TEST(NodeLoadOracle, AddsForcesPressureAndCorners) {
  Reals corner(48, 0.0);
  corner[3] = 1;
  corner[16 + 3] = 2;
  corner[32 + 3] = 4;
  KernelCase test("node_load", {}, Shape::items, 1);
  test.exact("node_load", {9, 9, 9, 9, 9, 9, 9, 9}).ints("load_node", {1}).ints("load_offset", {0, 0, 0, 1, 1, 1});
  test.exact("load_force", {1, 2, 3, 0}).ints("load_curve", {1}).ints("load_triangle", {1}).exact("load_weight", {0.5});
  test.ints("load_corner", {3}).exact("pressure_force", {0, 0, 0, 0, 10, 20, 30, 0}).exact("corner_force", corner);
  test.exact("curve_value", {0, 0, 0, 0, 7, 2}).integer(2).step();
  EXPECT_EQ(run_in_double(test, "node_load"), (Reals{9, 9, 9, 9, 2 + 5 - 1, 4 + 10 - 2, 6 + 15 - 4, 9}));
}

}  // namespace
}  // namespace pliant::kernel_test
