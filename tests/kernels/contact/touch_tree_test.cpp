// touch_tree: kernel and twin give the same bits; in double, the box of a group is that of all its points.
#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

class TouchTree : public TwinTest {};

TEST_F(TouchTree, TwinGivesTheSameBits) {
  for_touch_data(1200, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_tree_case(d), label); });
}

TEST(TouchTreeOracle, GroupsHoldTheirTiles) {
  TouchData d(1300, Data::large, 128);
  const Reals whole = d.box;  // make_boxes() has filled the group's
  const std::size_t group = PLIANT_TOUCH_BOX * (d.points / 16);
  std::fill(d.box.begin() + static_cast<std::ptrdiff_t>(group), d.box.end(), 7.0);
  const Reals box = run_in_double(touch_tree_case(d), "touch_box");
  for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_NEAR(box[k], whole[k], 1e-7) << k;
}

}  // namespace
}  // namespace pliant::kernel_test
