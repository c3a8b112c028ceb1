// contact_settle: kernel and twin give the same bits; in double, what points get, tools give.
#include "kernels/contact/contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactSettle : public TwinTest {};

TEST_F(ContactSettle, TwinGivesTheSameBits) {
  for_contact_data(300, [&](const ContactData& d, const std::string& label) {
    expect_same_bits(settle_case(d), label);
    expect_same_bits(settle_case(d, 1), label + ", with edges");
    expect_same_bits(settle_case(with_grips(d), 0, 1), label + ", with grips");
    expect_same_bits(settle_case(with_grips(d), 1, 1), label + ", with edges and grips");
    expect_same_bits(settle_case(with_starts(d)), label + ", after an edit");
    expect_same_bits(settle_case(with_starts(d), 1), label + ", after an edit, with edges");
    expect_same_bits(settle_case(with_faces(d), 1), label + ", with faces of a blade");
  });
}

TEST(ContactSettleOracle, ActionIsReactionInFixedPoint) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    ContactData d(500 + seed);
    for (std::size_t i = 0; i < d.points; ++i) {  // what touches is near, as contact_press leaves it
      std::int32_t& touching = d.force[ContactData::base(i, 4) + 48];
      touching &= d.near[i / 16];
    }
    expect_action_is_reaction(d, settle_case(d), "contact_change", {d.tool_force.begin(), d.tool_force.end()});
    expect_action_is_reaction(d, settle_case(d, 1), "contact_change", {d.tool_force.begin(), d.tool_force.end()}, 1);
    expect_action_is_reaction(d, settle_case(with_grips(d), 0, 1), "contact_change",
                              {d.tool_force.begin(), d.tool_force.end()});
  }
}

/// What is left of the depth is taken back with the weight that the first part had; what the next step begins with is that of
/// the points that touch, or may.
TEST(ContactSettleOracle, BothPartsWeighAlike) {
  ContactData d(540);
  std::fill(d.near.begin(), d.near.end(), 1);
  for (std::size_t i = 0; i < d.points; ++i) d.force[ContactData::base(i, 4) + 48] = i % 4 == 0 ? 0 : 1;
  std::fill(d.anchor.begin(), d.anchor.end(), 0.0);
  ContactData twice = d;
  for (double& y : twice.yield) y *= 2;
  const Reals change = ints_in_double(settle_case(d), "contact_change"),
              half = ints_in_double(settle_case(twice), "contact_change"),
              next = run_in_double(settle_case(d), "contact_yield");
  int pushed = 0, forgotten = 0;
  for (std::size_t i = 0; i < d.points; ++i) {
    const std::size_t at = ContactData::base(i, 4);
    if (d.force[at + 48] == 0) {
      EXPECT_EQ(next[i], 0);
      ++forgotten;
    }
    // A tool without friction, alone: the added force goes with 1 / W.
    if ((d.force[at + 48] & ~PLIANT_READY_BIT) != 1 || !(d.yield[i] > 0) || std::abs(change[at]) < 1e4) continue;
    if (std::abs(change[at]) > 6e7 || std::abs(half[at]) > 6e7) continue;  // the most that a point gets
    EXPECT_NEAR(change[at] / half[at], 2, 0.01) << i;
    ++pushed;
  }
  EXPECT_GT(forgotten, 0);
  EXPECT_GT(pushed, 0);
}

}  // namespace
}  // namespace pliant::kernel_test
