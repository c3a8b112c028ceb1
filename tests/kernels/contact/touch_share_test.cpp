// touch_share: kernel and twin give the same bits; in double, both points of a pair have the same area, and no point more than
// its own.
#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

class TouchShare : public TwinTest {};

TEST_F(TouchShare, TwinGivesTheSameBits) {
  for_touch_data(1800, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_share_case(d), label); });
}

TEST(TouchShareOracle, AreasAreMutualAndNoMoreThanTheSurface) {
  int pairs = 0, alone = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const TouchData d = tissue_alone(1900 + seed);
    const Reals numbers = run_in_double(touch_share_case(d), "touch_pair");
    for (std::size_t i = 0; i < d.points; ++i) {
      double sum = 0;
      for (std::size_t s = 0; s < 16; ++s) {
        const int name = d.partner[ContactData::base(i, 16) + 16 * s];
        const double area = numbers[TouchData::pair_at(i, s)];
        if (name == 0) {
          EXPECT_EQ(area, 0);
          continue;
        }
        const auto j = static_cast<std::size_t>(name) - 1;
        sum += area;
        double back = -1;
        for (std::size_t t = 0; t < 16; ++t) {
          if (d.partner[ContactData::base(j, 16) + 16 * t] == static_cast<int>(i) + 1) back = numbers[TouchData::pair_at(j, t)];
        }
        if (back < 0) {
          ++alone;
          EXPECT_EQ(area, 0);
          EXPECT_EQ(numbers[TouchData::pair_at(i, s) + 80], 0);  // it forgets where it stuck
          continue;
        }
        ++pairs;
        EXPECT_EQ(area, back);
        const double one = d.weights[ContactData::base(i, 17) + 256], two = d.weights[ContactData::base(j, 17) + 256];
        const double exact = d.area(i) * d.area(j) * d.weights[ContactData::base(i, 17) + 16 * s] / std::max(one, two);
        EXPECT_NEAR(area, exact, 1e-5 * exact);
      }
      EXPECT_LE(sum, d.area(i) * (1 + 1e-5));
    }
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_GT(alone, 20);
}

}  // namespace
}  // namespace pliant::kernel_test
