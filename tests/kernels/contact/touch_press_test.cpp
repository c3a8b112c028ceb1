// touch_press: kernel and twin give the same bits; in double, a pair is pushed apart by a d / (W_i + W_j), and action is
// reaction.
#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

using Eigen::Vector3d;

class TouchPress : public TwinTest {};

TEST_F(TouchPress, TwinGivesTheSameBits) {
  for_touch_data(2200, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_press_case(d), label); });
}

TEST(TouchPressOracle, ActionIsReactionToTheLastQuantum) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const TouchData d = tissue_alone(2300 + seed);
    expect_no_force_on_the_whole(d, touch_press_case(d));
  }
}

/// Of what tools do, points near a tool keep their part.
TEST(TouchPressOracle, ForcesOfToolsStay) {
  TouchData d(2350);
  d.near = {PLIANT_TOUCH_BIT | 3, 3, PLIANT_TOUCH_BIT, 0};
  const Reals with = ints_in_double(touch_press_case(d), "contact_change");
  TouchData alone = d;
  alone.near = {PLIANT_TOUCH_BIT, PLIANT_TOUCH_BIT, PLIANT_TOUCH_BIT, 0};
  const Reals without = ints_in_double(touch_press_case(alone), "contact_change");
  for (std::size_t i = 0; i < 48; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = ContactData::base(i, 4) + 16 * c;
      if (i < 16) {
        EXPECT_EQ(with[at], without[at] + d.force[at]);
      }
      if (i >= 16 && i < 32) {
        EXPECT_EQ(with[at], d.force[at]);
      }
      if (i >= 32) {
        EXPECT_EQ(with[at], without[at]);
      }
    }
  }
  for (std::size_t i = 48; i < 64; ++i) EXPECT_EQ(with[ContactData::base(i, 4)], d.change[ContactData::base(i, 4)]);
}

TEST(TouchPressOracle, DepthIsTakenBackAlongTheNormal) {
  int pushed = 0, apart = 0, rubbed = 0, limited = 0;
  for (const double friction : {0.0, 0.4}) {
    TouchData d = tissue_alone(2400);
    d.params[7] = friction;
    const KernelCase test = touch_press_case(d);
    const Reals change = ints_in_double(test, "contact_change"), force = ints_in_double(test, "touch_force"),
                depths = run_in_double(test, "touch_depth"), pair = run_in_double(test, "touch_pair");
    std::vector<double> deepest(d.depth);
    for (std::size_t i = 0; i < d.points; ++i) {
      double pressed = 0, inside = 0;
      bool ready = false;
      for (std::size_t s = 0; s < 16; ++s) {
        const int name = d.partner[ContactData::base(i, 16) + 16 * s];
        const double area = d.pair[TouchData::pair_at(i, s)];
        if (name == 0 || area == 0) continue;
        const auto j = static_cast<std::size_t>(name) - 1, lower = std::min(i, j), upper = std::max(i, j);
        const Vector3d n = (d.normal(upper) - d.normal(lower)).normalized();
        const double w = d.yielding(i) + d.yielding(j);
        const bool meets = w > 0 && d.front(lower, upper) < 0.48 * d.params[5];
        const Vector3d start = d.x(lower) - d.x(upper) - d.moved(lower) + d.moved(upper);
        const double had = d.pair[TouchData::pair_at(i, s) + 16];
        const bool limits = d.spacing(i) > 0 && d.spacing(j) > 0;  // as all partners outside of this test
        const double most = limits ? start.dot(n) + 4 * d.params[8] * std::max(d.spacing(i), d.spacing(j)) : had;
        EXPECT_NEAR(pair[TouchData::pair_at(i, s) + 16], meets ? std::min(had, most) : had, 1e-6);
        limited += meets && had > most;
        const double gap = d.gap(lower, upper), depth = pair[TouchData::pair_at(i, s) + 16] - gap;
        ready = ready || d.front(lower, upper) < 2 * (d.yield[i] > 0 ? 0.24 : 0.08) * d.params[5];
        if (std::abs(depth) < 1e-6) continue;
        const std::size_t at = TouchData::force_at(i, s);
        const bool pushes = depth > 0 && meets;
        EXPECT_EQ(force[at + 48], pushes ? 1 : 0);
        EXPECT_EQ(pair[TouchData::pair_at(i, s) + 80] != 0,
                  pushes && (friction > 0 || d.pair[TouchData::pair_at(i, s) + 80] != 0));
        (pushes ? pushed : apart) += 1;
        if (!pushes) continue;
        pressed += area;
        inside += area * ((d.moved(lower) - d.moved(upper)).dot(n) - gap);
        const Vector3d f = (i < j ? 1 : -1) * d.params[0] * Vector3d(force[at], force[at + 16], force[at + 32]);
        const double push = area * depth / w;
        if (push > 5e4) continue;  // the most that a pair gets
        EXPECT_NEAR(f.dot(n), push, 1e-4 * push + 2 * d.params[0]);
        const double side = (f - f.dot(n) * n).norm();
        EXPECT_LE(side, friction * push * (1 + 1e-4) + 2 * d.params[0]);
        rubbed += side > 0.5 * friction * push && friction > 0;
      }
      EXPECT_EQ(static_cast<int>(change[ContactData::base(i, 4) + 48]) & PLIANT_READY_BIT, ready ? PLIANT_READY_BIT : 0);
      if (pressed > 0) deepest[i] = std::max(deepest[i], inside / pressed);
    }
    for (std::size_t i = 0; i < d.points; ++i) EXPECT_NEAR(depths[i], deepest[i], 1e-6);
  }
  EXPECT_GT(pushed, 200);
  EXPECT_GT(apart, 200);
  EXPECT_GT(rubbed, 50);
  EXPECT_GT(limited, 20);
}

}  // namespace
}  // namespace pliant::kernel_test
