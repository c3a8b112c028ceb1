// tled_hex8full_force: kernel and twin give the same bits; the double twin gives what continuum mechanics says.
#include "kernels/elements/hex8_oracle.h"

namespace pliant::kernel_test {
namespace {

class TledHex8FullForce : public TwinTest {};

TEST_F(TledHex8FullForce, TwinGivesTheSameBits) {
  std::uint32_t seed = 400;
  for (const Law law : all_laws()) {
    for (int uniform = 0; uniform < 2; ++uniform) {
      for (const ElementSizes size : element_sizes) {
        for (const Data data : all_data) {
          expect_same_bits(hex8_case("tled_hex8full_force", PLIANT_HEXFULL_DATA_PLANES, law, uniform, size, data, seed++),
                           name_of(data));
        }
      }
    }
  }
}

TEST(TledHex8FullForceOracle, IsTheForceOfTheTextbookStressAndTheDerivativeOfTheEnergy) {
  expect_textbook_and_energy("tled_hex8full_force", eight_point_hexahedra(0.1, 8));
}

TEST(TledHex8FullForceOracle, AndThroughItsInversion) {
  const Hexahedra h = eight_point_hexahedra(0.8, 18);
  EXPECT_GT(low_points(h), 3);
  expect_textbook_and_energy("tled_hex8full_force", h);
}

TEST(TledHex8FullForceOracle, OneRecordServesAllElements) {
  expect_uniform_record("tled_hex8full_force", eight_point_hexahedra(0.1, 9));
}

}  // namespace
}  // namespace pliant::kernel_test
