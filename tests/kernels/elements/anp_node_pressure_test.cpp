// anp_node_pressure: kernel and twin give the same bits.
#include "kernels/elements/element_case.h"

namespace pliant::kernel_test {
namespace {

class AnpNodePressure : public TwinTest {};

KernelCase make_case(Law law, std::size_t nodes, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int elements = 200;
  Reals dilation = random.reals(elements, data, 1e-8);
  dilation.push_back(-0.0);
  Ints offset{0}, index;
  for (std::size_t tile = 0; tile < nodes / PLIANT_TILE; ++tile) {
    const int rows = random.integer(0, 9);
    for (int row = 0; row < rows; ++row) {
      for (int lane = 0; lane < PLIANT_TILE; ++lane)
        index.push_back(row <= lane % 10 ? random.integer(0, elements - 1) : elements);
    }
    offset.push_back(offset.back() + rows);
  }
  index.resize(index.size() + PLIANT_TILE, 0);
  KernelCase test("anp_node_pressure", with_law(law), Shape::lanes, nodes);
  test.reals("anp_dilation", std::move(dilation))
      .ints("anp_offset", std::move(offset))
      .ints("anp_index", std::move(index))
      .reals("anp_inverse_volume", random.reals(nodes, data == Data::bits ? data : Data::large, 1e7))
      .reals("anp_pressure", random.reals(nodes + 16, Data::large, 1))
      .reals("law_parameters", law_data(law))
      .integer(16);
  return test;
}

TEST_F(AnpNodePressure, TwinGivesTheSameBits) {
  std::uint32_t seed = 200;
  for (const Law law : all_laws()) {
    for (const std::size_t nodes : {16U, 80U, 2064U}) {
      for (const Data data : all_data) expect_same_bits(make_case(law, nodes, data, seed++), name_of(data));
    }
  }
}

/// Two elements of volumes 2 and 6 that grew by 1 and 4: J - 1 = (1 + 4) / (2 + 6) at their common node.
TEST(AnpNodePressureOracle, IsTheMeanWeightedByVolume) {
  Ints index(2 * 16, 2);
  index[0] = 0;
  index[16] = 1;
  KernelCase test("anp_node_pressure", with_law(Law::isochoric_neo_hookean), Shape::lanes, 16);
  test.reals("anp_dilation", {1, 4, -0.0}).ints("anp_offset", {0, 2}).ints("anp_index", index);
  test.reals("anp_inverse_volume", Reals(16, 1.0 / 8)).reals("anp_pressure", Reals(16, 99));
  test.reals("law_parameters", {0.25, 7, 1000}).integer(0);
  const Reals pressure = run_in_double(test, "anp_pressure");
  EXPECT_DOUBLE_EQ(pressure[0], 1000 * 5.0 / 8);
  EXPECT_EQ(pressure[1], 0);
}

/// The nodes of a second batch stand behind those of the first, whose pressures stay.
TEST(AnpNodePressureOracle, WritesFromItsBaseOn) {
  Ints index(16, 1);
  index[3] = 0;
  KernelCase test("anp_node_pressure", with_law(Law::neo_hookean), Shape::lanes, 16);
  test.reals("anp_dilation", {2, -0.0}).ints("anp_offset", {0, 1}).ints("anp_index", index);
  test.reals("anp_inverse_volume", Reals(16, 0.25)).reals("anp_pressure", Reals(48, 99));
  test.reals("law_parameters", {0.25, 1, 100}).integer(16);
  Reals expected(48, 99);
  for (std::size_t i = 16; i < 32; ++i) expected[i] = i == 16 + 3 ? 50 : 0;
  EXPECT_EQ(run_in_double(test, "anp_pressure"), expected);
}

}  // namespace
}  // namespace pliant::kernel_test
