// touch_place: kernel and twin give the same bits; in double, W is what a point yields to a pressure around it.
#include "kernels/contact/touch_case.h"

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
    TouchData d = tissue_alone(2100);
    std::fill(d.yield.begin(), d.yield.end(), 0.0);
    const KernelCase test = touch_place_case(d, again);
    const Reals place = run_in_double(test, "touch_place"), yield = run_in_double(test, "contact_yield");
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
      const std::size_t at = PLIANT_TOUCH_PLACE * i;
      if (again == 0) {
        EXPECT_NEAR(place[at + 3], yielding, 1e-5 * yielding) << i;
      } else {
        const bool counted = d.change[ContactData::base(i, 4) + 48] != 0;
        EXPECT_NEAR(yield[i], counted ? yielding : 0, 1e-5 * yielding) << i;
        EXPECT_EQ(place[at + 3], static_cast<double>(static_cast<float>(d.place[at + 3])));
      }
      const bool frame_stays = again != 0;
      EXPECT_EQ(place[at + 8] == static_cast<double>(static_cast<float>(d.place[at + 8])), frame_stays);
    }
    if (again != 0) {
      EXPECT_GT(held, 10);
    }
  }
}

/// A step begins with what the last one found out.
TEST(TouchPlaceOracle, BeginsWithTheYieldThatIsKnown) {
  TouchData d = tissue_alone(2120);
  const Reals place = run_in_double(touch_place_case(d, 0), "touch_place");
  int known = 0;
  for (std::size_t i = 0; i < d.points; ++i) {
    if (!(d.yield[i] > 0)) continue;
    EXPECT_EQ(place[PLIANT_TOUCH_PLACE * i + 3], static_cast<double>(static_cast<float>(d.yield[i])));
    ++known;
  }
  EXPECT_GT(known, 10);
}

/// The turn of the normal is what it does between the start and the end of the step, to first order.
TEST(TouchPlaceOracle, NormalsTurnWithTheirTangents) {
  for (const double size : {1e-3, 1e-4}) {
    TouchData d = tissue_alone(2130);
    for (std::size_t k = 0; k < d.node_w.size(); ++k) {
      if (k % 4 != 3) d.node_w[k] *= size / 1e-3;
    }
    const KernelCase test = touch_place_case(d, 0);
    TouchData after = d;
    after.place = run_in_double(test, "touch_place");
    for (std::size_t i = 0; i < d.points; ++i) {
      std::array<Eigen::Vector3d, 2> start, end;
      for (std::size_t k = 0; k < 2; ++k) {
        start[k] = end[k] = d.three(d.surface, i, PLIANT_TOUCH_SURFACE, 16 + 3 * k);
        for (std::size_t a = 0; a < 8; ++a) {
          const auto n = 4 * static_cast<std::size_t>(d.node[ContactData::base(i, 8) + 16 * a]);
          const double g = d.surface[ContactData::base(i, PLIANT_TOUCH_SURFACE) + 16 * (8 * k + a)];
          const Eigen::Vector3d u(&d.node_u[n]), w(&d.node_w[n]);
          end[k] += g * u;
          start[k] += g * (u - w);
        }
      }
      const Eigen::Vector3d before = start[0].cross(start[1]).normalized(), now = end[0].cross(end[1]).normalized();
      if (start[0].cross(start[1]).norm() < 0.3) continue;  // nearly flat
      EXPECT_LT((after.normal(i) - before).norm(), 1e-4);
      EXPECT_LT((after.row(i, 4) - (now - before)).norm(), 100 * (now - before).squaredNorm() + 1e-5);
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
