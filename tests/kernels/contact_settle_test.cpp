// contact_settle: kernel and twin give the same bits; in double, what points get, tools give.
#include "contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactSettle : public TwinTest {};

TEST_F(ContactSettle, TwinGivesTheSameBits) {
  for_contact_data(300, [&](const ContactData& d, const std::string& label) { expect_same_bits(settle_case(d), label); });
}

/// What points get, tools give, to the last quantum.
TEST(ContactSettleOracle, ActionIsReactionInFixedPoint) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const ContactData d(500 + seed);
    const KernelCase test = settle_case(d);
    const Reals force = ints_in_double(test, "contact_change"), sums = ints_in_double(test, "tool_sum");
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(on_points(d, force, c), -on_tools(sums, c));
      EXPECT_NE(on_points(d, force, c), 0);
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
