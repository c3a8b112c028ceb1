// contact_apply: kernel and twin give the same bits; in double, nodes get the whole force of the points.
#include "kernels/contact/contact_case.h"

namespace pliant::kernel_test {
namespace {

class ContactApply : public TwinTest {};

TEST_F(ContactApply, TwinGivesTheSameBits) {
  for_contact_data(400, [&](const ContactData& d, const std::string& label) {
    expect_same_bits(apply_case(d), label);
    expect_same_bits(apply_case(d, 1), label + ", with moments");
    expect_same_bits(apply_case(d, 1, 1), label + ", with moments and edges");
  });
}

/// The nodes get what the points have: in quanta, whatever the weights.
TEST(ContactApplyOracle, NodesGetTheWholeForce) {
  for (const int kind : {0, 1, 2}) {  // of points, with moments, with what edges do to corners
    const int moment = kind == 1 ? 1 : 0, edges = kind == 2 ? 1 : 0;
    ContactData d(700);
    d.near = {PLIANT_TOUCH_BIT | 1, 0, PLIANT_TOUCH_BIT | 3, 4};
    const KernelCase test = apply_case(d, moment, edges);
    const Reals sum = run_in_double(test, "contact_node_sum"), u = run_in_double(test, "node_u"),
                w = run_in_double(test, "node_w");
    for (std::size_t c = 0; c < 3; ++c) {
      double nodes = 0, points = 0;
      for (std::size_t s = 0; s < d.slots; ++s) {
        nodes += sum[4 * s + c] / d.params[2];
        const double b = 1e-6 * (1 + test.program().buffers[1].reals[4 * s + 3]) / 2;
        const double moved =
            (static_cast<int>(s % 8) >> c & 1) != 0 ? b * sum[4 * s + c] * test.program().buffers[0].reals[4 * s + 3] : 0;
        EXPECT_NEAR(u[4 * s + c] - test.program().buffers[0].reals[4 * s + c], moved, 1e-6 * std::abs(moved) + 1e-12);
        EXPECT_NEAR(w[4 * s + c] - test.program().buffers[1].reals[4 * s + c], moved, 1e-6 * std::abs(moved) + 1e-12);
      }
      for (std::size_t i = 0; i < d.points; ++i) {
        const std::size_t at = ContactData::base(i, 4);
        if (d.near[i / 16] == 0 || d.force[at + 48] == 0) continue;
        points += 4096.0 * d.force[at + 16 * c];
        for (std::size_t a = 0; a < 8 && edges != 0 && (d.near[i / 16] & ~PLIANT_TOUCH_BIT) != 0; ++a)
          points += 4096.0 * d.corner_force[ContactData::base(i, 24) + 16 * (3 * a + c)];
      }
      EXPECT_EQ(nodes, points);
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
