// tled_hex8_force: kernel and twin give the same bits; the double twin gives what continuum mechanics says.
#include "kernels/elements/hex8_oracle.h"

namespace pliant::kernel_test {
namespace {

class TledHex8Force : public TwinTest {};

TEST_F(TledHex8Force, TwinGivesTheSameBits) {
  std::uint32_t seed = 300;
  for (const Law law : all_laws()) {
    for (int uniform = 0; uniform < 2; ++uniform) {
      for (const ElementSizes size : element_sizes) {
        for (const Data data : all_data) {
          const std::size_t planes = uniform != 0 ? PLIANT_HEX_CUBE_RECORD : PLIANT_HEX_DATA_PLANES;
          expect_same_bits(hex8_case("tled_hex8_force", planes, law, uniform, size, data, seed++), name_of(data));
        }
      }
    }
  }
}

/// Sums that are zero are rare, and their signs differed in one of some hundred thousand numbers (cpu_ref/minus.h).
TEST_F(TledHex8Force, TwinGivesTheSameSignsOfZero) {
  for (std::uint32_t seed = 3600; seed < 3640; ++seed)
    expect_same_bits(
        hex8_case("tled_hex8_force", PLIANT_HEX_DATA_PLANES, Law::yeoh, 0, element_sizes[2], Data::underflow, seed),
        std::to_string(seed));
}

TEST(TledHex8ForceOracle, IsTheForceOfTheTextbookStressAndTheDerivativeOfTheEnergy) {
  expect_textbook_and_energy("tled_hex8_force", one_point_hexahedra(0.1, 8), true);
}

TEST(TledHex8ForceOracle, IsTheDerivativeOfTheEnergyWhereTheHourglassControlFollowsTheShape) {
  expect_textbook_and_energy("tled_hex8_force", shaped_hexahedra(0.1, 8));
}

TEST(TledHex8ForceOracle, AndThroughItsInversion) {
  const Hexahedra h = one_point_hexahedra(2.5, 18);
  EXPECT_GT(low_points(h), 3);
  expect_textbook_and_energy("tled_hex8_force", h, true);
  expect_textbook_and_energy("tled_hex8_force", shaped_hexahedra(2.5, 18));
}

}  // namespace
}  // namespace pliant::kernel_test
