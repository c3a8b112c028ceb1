// touch_place: kernel and twin give the same bits; in double, W is what a point yields to a pressure around it.
#include "touch_case.h"

namespace pliant::kernel_test {
namespace {

class TouchPlace : public TwinTest {};

TEST_F(TouchPlace, TwinGivesTheSameBits) {
  for_touch_data(2000, [&](const TouchData& d, const std::string& label) {
    expect_same_bits(touch_place_case(d, 0), label);
    expect_same_bits(touch_place_case(d, 1), label + ", again");
  });
}

TEST(TouchPlaceOracle, YieldsWithTheMassesAround) {
  for (const int again : {0, 1}) {
    const TouchData d = tissue_alone(2100);
    const KernelCase test = touch_place_case(d, again);
    const Reals place = run_in_double(test, "touch_place");
    const auto &u = test.program().buffers[0].reals, &w = test.program().buffers[1].reals;
    int held = 0;
    for (std::size_t i = 0; i < d.points; ++i) {
      double yielding = 0, whole = 0, moving = 0;
      for (std::size_t a = 0; a < 8; ++a) {
        const std::size_t at = ContactData::base(i, 8) + 16 * a, n = 4 * static_cast<std::size_t>(d.node[at]);
        const double factor = 1e-6 * (1 + w[n + 3]) / 2 * u[n + 3];
        const double share = again == 0 ? d.share[at] : d.weight[at] * d.node_sum[n + 3];
        whole += share;
        if (d.share[at] == 0) continue;
        moving += share;
        yielding += factor * share;
      }
      // The part of held nodes is the others' (of contact_share the host has seen to it).
      if (again != 0) {
        held += moving < whole;
        yielding *= moving > 0 ? whole / moving : 0;
      }
      EXPECT_NEAR(place[16 * i + 3], yielding, 1e-5 * yielding) << i;
      const bool frame_stays = again != 0;
      EXPECT_EQ(place[16 * i + 8] == static_cast<double>(static_cast<float>(d.place[16 * i + 8])), frame_stays);
    }
    if (again != 0) {
      EXPECT_GT(held, 10);
    }
  }
}

/// Points that no other is near are left alone.
TEST(TouchPlaceOracle, FarPointsAreLeftAlone) {
  TouchData d(2150);
  std::fill(d.near.begin(), d.near.end(), 31);
  const KernelCase test = touch_place_case(d, 0);
  EXPECT_EQ(run_in_double(test, "touch_place"), test.program().at(test.program().find("touch_place")).reals);
}

}  // namespace
}  // namespace pliant::kernel_test
