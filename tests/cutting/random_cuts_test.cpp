// Random planar, curved, repeated and degenerate cuts of small bodies. PLIANT_RANDOM_CUTS sets how many (the default is for
// CI).
#include <cstdlib>

#include "cutting/cut_bodies.h"

namespace pliant {
namespace {

using namespace cut_test;

int wanted_cuts() {
  const char* text = std::getenv("PLIANT_RANDOM_CUTS");
  return text != nullptr ? std::atoi(text) : 400;
}

class RandomBlade {
 public:
  explicit RandomBlade(unsigned seed) : random_(seed) {}

  /// A plane, or a strip along a random walk; now and then through grid points exactly.
  std::vector<SweepTriangle> next() {
    if (pick(3) == 0) return walk();
    Vec3d point{}, normal{};
    for (int a = 0; a < 3; ++a) {
      point[a] = pick(2) == 0 ? pick(4) : real(0, 3);
      normal[a] = pick(2) == 0 ? pick(3) - 1 : real(-1, 1);
    }
    if (vec::norm(normal) < 0.1) normal = {1, 0, 0};
    return plane_cut(point, normal, pick(4) == 0 ? 1.5 : 20);
  }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::vector<SweepTriangle> walk() {
    std::vector<SweepTriangle> all;
    const auto point = [&](double z) { return Vec3d{real(-0.5, 3.5), real(-0.5, 3.5), z}; };
    BladeSegment blade{point(-1), point(4)};
    for (int k = 2 + pick(6); k > 0; --k) {
      const BladeSegment next{pick(4) == 0 ? blade[0] : point(real(-1, 1)), point(real(2, 4))};
      const auto part = sweep(blade, next);
      all.insert(all.end(), part.begin(), part.end());
      blade = next;
    }
    return all;
  }
  std::mt19937 random_;
};

class RandomCuts : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Cutting, RandomCuts, ::testing::Bool(),
                         [](const auto& shape) { return shape.param ? "tetrahedra" : "lattice"; });

/// Mass, momentum and consistency of the edit from `before` to the body now.
void check_edit(const CutElements& before, const CutTopology& body, const CutEdit& edit, RandomBlade& random) {
  const CutElements& now = body.elements();
  if (!edit.changed_elements()) {
    expect_same(before, now);
    return;
  }
  ASSERT_EQ(edit.node_from.size(), now.origin.size());
  ASSERT_EQ(edit.element_from.size(), now.nodes.size());
  const int corners = body.mesh().shape->corners;
  std::vector<double> mass(now.origin.size(), 0.0), speed(before.origin.size());
  for (double& v : speed) v = random.real(-1, 1);
  double momentum_before = 0, momentum = 0;
  for (std::size_t e = 0; e < before.nodes.size(); ++e) {
    for (int a = 0; a < corners; ++a) momentum_before += before.fill[e] * speed[before.nodes[e][a]];
  }
  for (std::size_t e = 0; e < now.nodes.size(); ++e) {
    ASSERT_EQ(now.cell[e], before.cell[edit.element_from[e]]);
    for (int a = 0; a < corners; ++a) {
      const std::int32_t from = edit.node_from[now.nodes[e][a]];
      EXPECT_EQ(from, before.nodes[edit.element_from[e]][a]) << "a node comes from two";
      mass[now.nodes[e][a]] += now.fill[e];
      momentum += now.fill[e] * speed[from];
    }
  }
  std::vector<double> inherited(before.nodes.size());
  for (std::size_t e = 0; e < now.nodes.size(); ++e) inherited[edit.element_from[e]] += now.fill[e];
  for (std::size_t e = 0; e < before.nodes.size(); ++e)
    EXPECT_NEAR(inherited[e], before.fill[e], 1e-14) << "fill changed hands";
  EXPECT_NEAR(momentum, momentum_before, 1e-12 * corners * static_cast<double>(now.nodes.size()));
  for (const double m : mass) EXPECT_GT(m, 0);
}

TEST_P(RandomCuts, EveryCutKeepsTheFillOfEveryCopyAndSoMassAndMomentum) {
  RandomBlade random(7);
  const int wanted = GetParam() ? wanted_cuts() / 2 : wanted_cuts();
  int done = 0, split = 0;
  while (done < wanted) {
    const auto mesh = box_mesh(3, 3, 1 + random.pick(3), GetParam());
    CutTopology body(mesh);
    for (int k = 1 + random.pick(5); k > 0; --k, ++done) {
      const CutElements before = body.elements();
      const CutEdit edit = cut_at_rest(body, random.next());
      check_edit(before, body, edit, random);
      split += edit.changed_elements();
    }
    check_body(body, random.pick(4) == 0);
    check_from_scratch(body, mesh);
    if (HasFailure()) FAIL() << "after " << done << " cuts";
  }
  EXPECT_GT(split, wanted / 3);
}

}  // namespace
}  // namespace pliant
