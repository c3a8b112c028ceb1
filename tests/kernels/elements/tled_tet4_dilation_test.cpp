// tled_tet4_dilation: kernel and twin give the same bits; the double twin gives V (det F - 1).
#include "kernels/elements/oracle_element.h"

namespace pliant::kernel_test {
namespace {

class TledTet4Dilation : public TwinTest {};

TEST_F(TledTet4Dilation, TwinGivesTheSameBits) {
  std::uint32_t seed = 100;
  for (const ElementSizes size : element_sizes) {
    for (const Data data : all_data) expect_same_bits(tet4_dilation_case(size, data, seed++), name_of(data));
  }
}

TEST(TledTet4DilationOracle, IsTheChangeOfVolume) {
  Random random(7);
  std::vector<Point> points;
  std::vector<Shift> u;
  std::vector<Reals> records;
  for (int e = 0; e < 16; ++e) {
    points.push_back(random_tetrahedron(random));
    u.push_back(random_shift(random, 4, 0.2));
    records.emplace_back();
    for (std::size_t a = 1; a < 4; ++a) {
      for (int c = 0; c < 3; ++c) records.back().push_back(points.back().gradient[a][c]);
    }
    records.back().push_back(points.back().weight);
  }
  KernelCase test("tled_tet4_dilation", {}, Shape::lanes, 16);
  test.exact("node_u", texels_of(u))
      .ints("nodes", own_nodes(4))
      .exact("data", planes_of(records))
      .exact("anp_dilation", Reals(16));
  const Reals dilation = run_in_double(test, "anp_dilation");
  for (std::size_t e = 0; e < 16; ++e) {
    const double expected = points[e].weight * (deformation_gradient(points[e], u[e]).determinant() - 1);
    EXPECT_NEAR(dilation[e], expected, 1e-14 * points[e].weight);
  }
}

}  // namespace
}  // namespace pliant::kernel_test
