// contact_tool_sum: kernel and twin give the same bits; the sums are those of every point that touches, to the last quantum.
#include "kernels/contact/contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactToolSum : public TwinTest {};

/// Seven tiles or a hundred, so that some parts have none and some have many.
ContactData with_points(std::uint32_t seed, Data kind) { return ContactData(seed, kind, seed % 2 == 0 ? 112 : 1600); }

TEST_F(ContactToolSum, TwinGivesTheSameBits) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    expect_same_bits(tool_sum_case(with_points(400 + seed, all_data[seed % std::size(all_data)])), std::to_string(seed));
  }
}

TEST(ContactToolSumOracle, CountsEveryPointThatTouchesOnce) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    ContactData d = with_points(600 + seed, Data::large);
    for (std::size_t at = 112; at < d.tool_force.size(); at += 128) {  // work of spreading, in all lanes of a tile
      for (std::size_t l = 0; l < 16; ++l) d.tool_force[at + l] *= static_cast<std::int32_t>(1 + 2 * ((at + 37 * l) % 5000));
    }
    const Reals all = ints_in_double(tool_sum_case(d), "tool_sum"), force(d.tool_force.begin(), d.tool_force.end());
    for (std::size_t t = 0; t < ContactData::tools; ++t) {
      std::array<double, 7> sum{};
      double deepest = 0, count = 0, spread = 0, work = 0;
      for (std::size_t part = 0; part < 16; ++part) {
        const double* s = &all[18 * (16 * (test_step * ContactData::tools + t) + part)];
        for (std::size_t c = 0; c < 7; ++c) sum[c] += 32768 * s[2 * c] + s[2 * c + 1];
        deepest = std::max(deepest, s[14]);
        count += s[15];
        spread += 32768 * s[16] + s[17];
      }
      double area = 0, touching = 0, depth = 0;
      for (std::size_t i = 0; i < d.points; ++i) {
        const std::size_t at = 8 * d.points * t + ContactData::base(i, 8);
        if ((d.near[i / 16] >> t & 1) == 0 || force[at + 112] == 0) continue;
        area += std::rint(d.rest[ContactData::base(i, 4) + 48] * d.params[4]);
        depth = std::max(depth, force[at + 96]);
        work += (force[at + 112] - 1) / 2;
        ++touching;
      }
      for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(sum[c], on_tool(d, force, t, c)) << "tool " << t;
      EXPECT_NEAR(sum[6], area, 1 + touching);  // the case is rounded to float
      EXPECT_EQ(deepest, depth);
      EXPECT_EQ(count, touching);
      EXPECT_EQ(spread, work);
      EXPECT_GT(work, 0);
      EXPECT_GT(count, 0);
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
