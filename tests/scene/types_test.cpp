#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"

namespace pliant {
namespace {

TEST(MaterialTest, YoungAndPoissonFollowFromTheModuli) {
  const Moduli m = Moduli::from_lame(2000, 1000);
  // E = mu (3 lambda + 2 mu) / (lambda + mu), nu = lambda / (2 (lambda + mu))
  EXPECT_NEAR(m.young(), 1000.0 * 8000 / 3000, 1e-9);
  EXPECT_NEAR(m.poisson(), 2000.0 / 6000, 1e-15);
}

Selection box(const Vec3d& lo, const Vec3d& hi) {
  Selection s;
  s.kind = Selection::Kind::box;
  s.a = lo;
  s.b = hi;
  return s;
}

TEST(SelectionTest, BoxIsInclusiveWithSlack) {
  const Selection s = box({0, 0, 0}, {1, 2, 0});  // flat: a face of nodes
  EXPECT_TRUE(s.contains({0, 0, 0}, 0));
  EXPECT_TRUE(s.contains({1, 2, 0}, 0));
  EXPECT_TRUE(s.contains({1 + 1e-9, 2, -1e-9}, 0));
  EXPECT_FALSE(s.contains({1 + 1e-8, 1, 0}, 0));
  EXPECT_FALSE(s.contains({0.5, 1, 1e-8}, 0));
  EXPECT_FALSE(s.contains({std::nan(""), 1, 0}, 0));
}

TEST(SelectionTest, SphereIsInclusiveWithSlack) {
  Selection s;
  s.kind = Selection::Kind::sphere;
  s.a = {1, 1, 1};
  s.radius = 0.5;
  EXPECT_TRUE(s.contains({1.5, 1, 1}, 0));
  EXPECT_TRUE(s.contains({1, 1 - 0.5 - 5e-10, 1}, 0));
  EXPECT_FALSE(s.contains({1, 1, 1.5 + 1e-8}, 0));
  EXPECT_FALSE(s.contains({1.4, 1.4, 1}, 0));
}

TEST(SelectionTest, PlaneChoosesTheSideOfItsNormal) {
  Selection s;
  s.kind = Selection::Kind::plane;
  s.a = {0, 0.1, 0};
  s.b = {0, -30, 0};  // the length of the normal does not matter
  EXPECT_TRUE(s.contains({5, 0.1, 5}, 0));
  EXPECT_TRUE(s.contains({0, 0.1 + 5e-11, 0}, 0));
  EXPECT_TRUE(s.contains({0, -7, 0}, 0));
  EXPECT_FALSE(s.contains({0, 0.1 + 1e-9, 0}, 0));
}

TEST(SelectionTest, NodesAndAll) {
  Selection s;
  EXPECT_TRUE(s.contains({1, 2, 3}, 99));
  s.kind = Selection::Kind::nodes;
  s.nodes = {2, 3, 7};
  EXPECT_TRUE(s.contains({0, 0, 0}, 3));
  EXPECT_FALSE(s.contains({0, 0, 0}, 4));
}

TEST(CurveTest, ConstantBeginsAtStart) {
  Curve c;
  EXPECT_EQ(c.value(0), 1);
  c.start = 2;
  EXPECT_EQ(c.value(1.9), 0);
  EXPECT_EQ(c.value(2), 1);
}

TEST(CurveTest, RampIsLinear) {
  const Curve c{Curve::Kind::ramp, 1, 4, {}};
  EXPECT_EQ(c.value(0), 0);
  EXPECT_EQ(c.value(1), 0);
  EXPECT_EQ(c.value(2), 0.25);
  EXPECT_EQ(c.value(5), 1);
  EXPECT_EQ(c.value(50), 1);
}

TEST(CurveTest, SmoothIsTheQuinticWithFlatEnds) {
  const Curve c{Curve::Kind::smooth, 0, 2, {}};
  EXPECT_EQ(c.value(0), 0);
  EXPECT_DOUBLE_EQ(c.value(1), 0.5);
  EXPECT_DOUBLE_EQ(c.value(0.5), 10 / 64.0 - 15 / 256.0 + 6 / 1024.0);
  EXPECT_EQ(c.value(2), 1);
  const double h = 1e-4;
  for (const double end : {0.0, 2.0}) EXPECT_NEAR((c.value(end + h) - c.value(end - h)) / (2 * h), 0, 1e-6);
}

TEST(CurveTest, TableIsLinearInBetweenAndHeldOutside) {
  const Curve c{Curve::Kind::table, 0, 0, {{1, 10}, {2, 20}, {4, 0}}};
  EXPECT_EQ(c.value(-5), 10);
  EXPECT_EQ(c.value(1), 10);
  EXPECT_EQ(c.value(1.5), 15);
  EXPECT_EQ(c.value(2), 20);
  EXPECT_EQ(c.value(3), 10);
  EXPECT_EQ(c.value(9), 0);
}

TEST(Names, AreThoseOfTheSceneFile) {
  EXPECT_STREQ(to_string(Law::isochoric_neo_hookean), "isochoric-neo-hookean");
  EXPECT_STREQ(to_string(Law::saint_venant_kirchhoff), "saint-venant-kirchhoff");
  EXPECT_STREQ(to_string(ElementKind::tet4anp), "tet4anp");
  EXPECT_STREQ(to_string(ElementKind::hex8full), "hex8full");
}

}  // namespace
}  // namespace pliant
