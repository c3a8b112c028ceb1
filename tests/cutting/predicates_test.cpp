// The exact decisions: signs, ties, and that ties are broken as by one common movement of the points.
#include "geometry/predicates.h"

#include <gtest/gtest.h>

#include <random>

namespace pliant {
namespace {

ExactPoint point(std::mt19937& random, int range, std::int64_t id) {
  ExactPoint p{{}, id};
  for (auto& c : p.x) c = static_cast<std::int64_t>(random() % static_cast<unsigned>(range));
  return p;
}

bool inside(const ExactPoint& p, const std::array<ExactPoint, 4>& t) {
  const int all = orient(t[0], t[1], t[2], t[3]);
  return orient(p, t[1], t[2], t[3]) == all && orient(t[0], p, t[2], t[3]) == all && orient(t[0], t[1], p, t[3]) == all &&
         orient(t[0], t[1], t[2], p) == all;
}

TEST(Predicates, Signs) {
  const ExactFrame frame({{-1, -1, -1}, {1, 1, 1}});
  const ExactPoint a = frame.snap({0, 0, 0}, 0), b = frame.snap({1, 0, 0}, 1), c = frame.snap({0, 1, 0}, 2);
  EXPECT_EQ(orient(a, b, c, frame.snap({0.3, 0.3, 1e-11}, 3)), 1);
  EXPECT_EQ(orient(a, b, c, frame.snap({0.3, 0.3, -1e-11}, 3)), -1);
  EXPECT_EQ(crosses(frame.snap({0.2, 0.2, -1}, 3), frame.snap({0.2, 0.2, 1}, 4), a, b, c), 1);
  EXPECT_EQ(crosses(frame.snap({0.2, 0.2, 1}, 3), frame.snap({0.2, 0.2, -1}, 4), a, b, c), -1);
  EXPECT_EQ(crosses(frame.snap({0.8, 0.8, 1}, 3), frame.snap({0.8, 0.8, -1}, 4), a, b, c), 0);
}

// The corners of the grid take 39 bits in differences, and 118 in the determinant.
TEST(Predicates, TheEndsOfTheRange) {
  const ExactFrame frame({{-1, -1, -1}, {1, 1, 1}});
  const ExactPoint a = frame.snap({-1, -1, -1}, 0), b = frame.snap({1, 1, -1}, 1), c = frame.snap({1, -1, 1}, 2);
  EXPECT_EQ(orient(a, b, c, frame.snap({-1, 1, 1}, 3)), -1);
  ExactPoint d = a;  // moved by one step from the plane of a, b and c
  d.id = 3;
  d.x[2] += 1;
  const int above = orient(a, b, c, d);
  d.x[2] -= 2;
  EXPECT_EQ(orient(a, b, c, d), -above);
}

TEST(Predicates, SwappingTwoPointsSwapsTheSign) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::array<ExactPoint, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = point(random, 1 + i % 4, k);
    const int s = orient(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(orient(p[1], p[0], p[2], p[3]), -s);
    ASSERT_EQ(orient(p[0], p[2], p[1], p[3]), -s);
    ASSERT_EQ(orient(p[0], p[1], p[3], p[2]), -s);
  }
}

// What holds for points in general position has to hold for every answer: a segment enters and leaves a tetrahedron through its
// faces as often as its ends say. Coordinates from a range of 1 to 4 make nearly every decision a tie.
TEST(Predicates, TiesAreBrokenConsistently) {
  std::mt19937 random(2);
  constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (int i = 0; i < 50000; ++i) {
    std::array<ExactPoint, 4> t;
    for (int k = 0; k < 4; ++k) t[k] = point(random, 1 + i % 4, (k * 7 + i) % 13);
    const ExactPoint u = point(random, 1 + i % 4, (i % 2 == 0 ? -1 : 20)), w = point(random, 1 + i % 4, 30);
    const int all = orient(t[0], t[1], t[2], t[3]);
    int entered = 0;
    for (const auto& f : kFaces) entered -= all * crosses(u, w, t[f[0]], t[f[1]], t[f[2]]);
    ASSERT_EQ(entered, int{inside(w, t)} - int{inside(u, t)});
  }
}

}  // namespace
}  // namespace pliant
