// touch_box: kernel and twin give the same bits; in double, points stand where their nodes put them, normals are those of the
// deformed tangents, and boxes hold all of it and no more.
#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

class TouchBox : public TwinTest {};

TEST_F(TouchBox, TwinGivesTheSameBits) {
  for_touch_data(1000, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_box_case(d), label); });
}

TEST(TouchBoxOracle, PlacesNormalsAndBoxes) {
  TouchData d(1100);
  const KernelCase test = touch_box_case(d);
  const Reals box = run_in_double(test, "touch_box");
  const auto &u = test.program().buffers[0].reals, &w = test.program().buffers[1].reals;
  d.place = run_in_double(test, "touch_place");
  for (std::size_t i = 0; i < d.points; ++i) {
    Eigen::Vector3d x = d.three(d.rest, i, 4, 0), one = d.three(d.surface, i, PLIANT_TOUCH_SURFACE, 16),
                    two = d.three(d.surface, i, PLIANT_TOUCH_SURFACE, 19);
    for (std::size_t a = 0; a < 8; ++a) {
      const auto node = 4 * static_cast<std::size_t>(d.node[ContactData::base(i, 8) + 16 * a]);
      x += d.weight[ContactData::base(i, 8) + 16 * a] * Eigen::Vector3d(&u[node]);
      const Eigen::Vector3d moved = Eigen::Vector3d(&u[node]) - Eigen::Vector3d(&w[node]);  // at the start of the step
      one += d.surface[ContactData::base(i, PLIANT_TOUCH_SURFACE) + 16 * a] * moved;
      two += d.surface[ContactData::base(i, PLIANT_TOUCH_SURFACE) + 16 * (8 + a)] * moved;
    }
    EXPECT_LT((d.x(i) - x).norm(), 1e-6);
    EXPECT_LT((d.normal(i) - one.cross(two).normalized()).norm(), 1e-5);
    EXPECT_LT((d.row(i, 3) - one.normalized()).norm(), 1e-5);
  }
  d.make_boxes();
  for (std::size_t k = 0; k < PLIANT_TOUCH_BOX * (d.points / 16); ++k) EXPECT_NEAR(box[k], d.box[k], 1e-7) << k;
}

}  // namespace
}  // namespace pliant::kernel_test
