// touch_settle: kernel and twin give the same bits; in double, action is reaction, and friction keeps within its cone.
#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

using Eigen::Vector3d;

class TouchSettle : public TwinTest {};

TEST_F(TouchSettle, TwinGivesTheSameBits) {
  for_touch_data(2500, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_settle_case(d), label); });
}

TEST(TouchSettleOracle, ActionIsReactionToTheLastQuantum) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const TouchData d = tissue_alone(2600 + seed);
    expect_no_force_on_the_whole(d, touch_settle_case(d));
  }
}

/// One pair, by the book: what is left of the depth is taken back, and friction of both parts together keeps within its cone.
TEST(TouchSettleOracle, FrictionKeepsWithinItsCone) {
  int slips = 0, sticks = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    TouchData d = tissue_alone(2700 + seed);
    const double friction = seed % 2 == 0 ? 0.4 : 10;
    d.params[7] = friction;
    std::fill(d.partner.begin(), d.partner.end(), 0);
    std::fill(d.change.begin(), d.change.end(), 0);
    const std::size_t i = 3, j = 40;
    Random random(seed);
    const std::array<double, 6> numbers{
        1e-3, 0, random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 1};
    const std::array<int, 3> before{random.integer(-90000, 90000), random.integer(-90000, 90000),
                                    random.integer(-90000, 90000)};
    for (const auto& [own, other] : {std::pair{i, j}, std::pair{j, i}}) {
      d.partner[ContactData::base(own, 16)] = static_cast<std::int32_t>(other + 1);
      for (std::size_t k = 0; k < 6; ++k) d.pair[TouchData::pair_at(own, 0) + 16 * k] = numbers[k];
      for (std::size_t k = 0; k < 3; ++k)
        d.pair_force[TouchData::force_at(own, 0) + 16 * k] = own == i ? before[k] : -before[k];
      d.pair_force[TouchData::force_at(own, 0) + 48] = 1;
      d.yielding(own) = 5e-6;
    }
    const KernelCase test = touch_settle_case(d);
    const Reals change = ints_in_double(test, "contact_change"), pair = run_in_double(test, "touch_pair");
    const Vector3d n = (d.normal(j) - d.normal(i)).normalized();
    const double stiffness = 1e-3 / 1e-5, rest = std::max(0.0, -d.gap(i, j));
    const Vector3d had = d.params[0] * Vector3d(before[0], before[1], before[2]);
    const Vector3d got = had + d.params[0] * Vector3d(change[ContactData::base(i, 4)], change[ContactData::base(i, 4) + 16],
                                                      change[ContactData::base(i, 4) + 32]);
    const Reals whole = ints_in_double(test, "touch_force");
    EXPECT_NEAR((d.params[0] * d.three(whole, i, 16 * PLIANT_TOUCH_FORCE, 0) - got).norm(), 0, 0.01)
        << "the force of both parts";
    const double across = had.dot(n) + stiffness * rest;
    EXPECT_NEAR(got.dot(n), across, 1e-3 * std::abs(across) + 0.01);
    const double side = (got - got.dot(n) * n).norm(), most = friction * std::max(0.0, across);
    EXPECT_LE(side, most * 1.001 + 0.01);
    const Vector3d t = d.row(i, 3), b = d.normal(i).cross(t);
    const Vector3d stuck = numbers[2] * t + numbers[3] * b + numbers[4] * d.normal(i);
    const Vector3d slip = d.x(i) - d.x(j) - stuck, along = slip - slip.dot(n) * n;
    const Vector3d wanted = had - had.dot(n) * n - stiffness * along;
    const bool slipping = wanted.norm() > most;
    (slipping ? slips : sticks) += 1;
    if (!slipping) {
      EXPECT_LT((got - got.dot(n) * n - wanted).norm(), 1e-3 * wanted.norm() + 0.01);
    }
    // Where it slips, the place where it stuck is as far away as friction can hold.
    const Vector3d now = pair[TouchData::pair_at(i, 0) + 32] * t + pair[TouchData::pair_at(i, 0) + 48] * b +
                         pair[TouchData::pair_at(i, 0) + 64] * d.normal(i);
    const Vector3d left = d.x(i) - d.x(j) - now, left_along = left - left.dot(n) * n;
    EXPECT_NEAR(left_along.norm(), slipping ? std::min(along.norm(), most / stiffness) : along.norm(), 1e-5);
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_EQ(pair[TouchData::pair_at(i, 0) + 16 * k], pair[TouchData::pair_at(j, 0) + 16 * k]);
  }
  EXPECT_GT(slips, 5);
  EXPECT_GT(sticks, 3);
}

}  // namespace
}  // namespace pliant::kernel_test
