// contact_near: kernel and twin give the same bits; in double, near is what lies within the margin.
#include "kernels/contact/contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactNear : public TwinTest {};

TEST_F(ContactNear, TwinGivesTheSameBits) {
  for_contact_data(100, [&](const ContactData& d, const std::string& label) {
    expect_same_bits(near_case(d), label);
    expect_same_bits(near_case(d, 1), label + ", with edges");
    expect_same_bits(near_case(with_grips(d)), label + ", with grips");
    expect_same_bits(near_case(with_faces(d), 1), label + ", with faces of a blade");
  });
}

/// A look keeps what is within reach, and forgets the anchors of the rest.
TEST(ContactNearOracle, NearIsWithinTheMargin) {
  ContactData d(800);
  std::fill(d.node_u.begin(), d.node_u.end(), 0.0);
  std::fill(d.node_w.begin(), d.node_w.end(), 0.0);
  for (std::size_t t = 0; t < ContactData::tools; ++t) d.kind[8 * t] = 0;
  d.pose.clear();
  for (std::size_t row = 0; row < ContactData::rows * ContactData::tools; ++row)
    d.pose.insert(d.pose.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
  for (std::size_t i = 0; i < d.points; ++i) {  // tile k lies 0.3 k from the origin
    for (std::size_t c = 0; c < 3; ++c)
      d.rest[ContactData::base(i, 4) + 16 * c] = c == 0 ? 0.3 * static_cast<double>(i / 16) : 0;
  }
  for (std::size_t t = 0; t < ContactData::tools; ++t) d.data[20 * t] = 0.1 + 0.26 * static_cast<double>(t);
  std::fill(d.near.begin(), d.near.end(), 31);
  const Reals near = ints_in_double(near_case(d), "contact_near"), anchor = run_in_double(near_case(d), "contact_anchor");
  EXPECT_EQ(near, (Reals{31, 31 - 1, 31 - 3, 31 - 7}));
  d.rest[ContactData::base(63, 4)] = 5;
  for (std::size_t i = 48; i < 64; ++i) d.rest[ContactData::base(i, 4)] = 5;
  const Reals far = ints_in_double(near_case(d), "contact_near"), forgotten = run_in_double(near_case(d), "contact_anchor");
  EXPECT_EQ(far[3], 0);
  for (std::size_t k = 192; k < 256; ++k) EXPECT_EQ(forgotten[k], 0);
  EXPECT_EQ(Reals(anchor.begin(), anchor.begin() + 192), Reals(forgotten.begin(), forgotten.begin() + 192));
}

}  // namespace
}  // namespace pliant::kernel_test
