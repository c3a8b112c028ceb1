// contact_settle: kernel and twin give the same bits; in double, what points get, tools give.
#include "contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactSettle : public TwinTest {};

TEST_F(ContactSettle, TwinGivesTheSameBits) {
  for_contact_data(300, [&](const ContactData& d, const std::string& label) { expect_same_bits(settle_case(d), label); });
}

TEST(ContactSettleOracle, ActionIsReactionInFixedPoint) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    ContactData d(500 + seed);
    for (std::size_t i = 0; i < d.points; ++i) {  // what touches is near, as contact_press leaves it
      std::int32_t& touching = d.force[ContactData::base(i, 4) + 48];
      touching &= d.near[i / 16];
    }
    expect_action_is_reaction(d, settle_case(d), "contact_change", {d.tool_force.begin(), d.tool_force.end()});
  }
}

}  // namespace
}  // namespace pliant::kernel_test
