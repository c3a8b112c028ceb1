// The stable step through random cuts. What is guaranteed is the element bound: an element's copies have its stiffness and its
// mass in the same proportion, so the bound never changes, and no body is less stable than its elements (Irons and Treharne
// 1971). PLIANT_RANDOM_CUTS sets how many cuts (the default is for CI).
#include <gtest/gtest.h>

#include <cstdlib>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"

namespace pliant {
namespace {

using namespace cut_test;

class CutSteps : public ::testing::TestWithParam<ElementKind> {};
INSTANTIATE_TEST_SUITE_P(Cutting, CutSteps, ::testing::Values(ElementKind::hex8, ElementKind::tet4),
                         [](const auto& element) { return std::string(to_string(element.param)); });

/// A plane or a strip along a random walk, every other time through grid points.
std::vector<SweepTriangle> random_blade(std::mt19937& random) {
  const auto pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  if (pick(3) == 0) {
    std::vector<SweepTriangle> all;
    const auto point = [&](double z) { return Vec3d{real(-0.005, 0.025), real(-0.005, 0.025), z}; };
    BladeSegment from{point(-0.01), point(0.04)};
    for (int k = 2 + pick(5); k > 0; --k) {
      const BladeSegment to{pick(4) == 0 ? from[0] : point(real(-0.01, 0.01)), point(real(0.01, 0.04))};
      const auto part = sweep(from, to);
      all.insert(all.end(), part.begin(), part.end());
      from = to;
    }
    return all;
  }
  Vec3d point{}, normal{};
  for (int a = 0; a < 3; ++a) {
    point[a] = pick(2) == 0 ? 0.01 * pick(3) : real(0, 0.02);
    normal[a] = pick(2) == 0 ? pick(3) - 1 : real(-1, 1);
  }
  if (vec::norm(normal) < 0.1) normal = {1, 0, 0};
  return plane_cut(point, normal, pick(4) == 0 ? 0.01 : 1);
}

TEST_P(CutSteps, NoCutTakesTheStepAway) {
  const char* text = std::getenv("PLIANT_RANDOM_CUTS");
  const int wanted = text != nullptr ? std::atoi(text) / 2 : 60;
  std::mt19937 random(17);
  Scene scene = scene_with(box_body("box", {0.02, 0.02, 0.02}, GetParam()));
  scene.blades.push_back(blade("far", {{0, 9, 9, 9, 9, 9, 10}, {1, 9, 9, 9, 9, 9, 10}}));  // this scene is meant to be cut
  const auto model = std::make_shared<const Model>(build_model(scene));
  double least = HUGE_VAL, uncut = 0;
  int done = 0, split = 0;
  while (done < wanted) {
    Simulation s(scene, model, open_backend("cpu:double"));
    const double dt = s.dt(), bound = s.model().element_bound;
    uncut = s.estimate_stable_dt(150);
    for (int k = 0; k < 5 && done < wanted; ++k, ++done) {
      const CutReport report = s.cut(random_blade(random));
      split += report.changed;
      ASSERT_EQ(s.model().element_bound, bound);
      ASSERT_EQ(s.dt(), dt) << "the step of a scene with blades is that of its elements";
      if (!report.changed) continue;
      const double limit = s.estimate_stable_dt(150);  // of the whole body as it is cut now; at most 2 % too low
      least = std::min(least, limit);
      ASSERT_GE(limit, 0.99 * bound) << "after " << done << " cuts";
    }
  }
  EXPECT_GT(split, wanted / 3);
  std::printf("%s: %d cuts, %d split; element bound %.5g s; limit of the body %.5g s uncut, least after cuts %.5g s\n",
              to_string(GetParam()), done, split, model->element_bound, uncut, least);
}

}  // namespace
}  // namespace pliant
