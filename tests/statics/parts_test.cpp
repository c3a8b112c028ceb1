// Quadrature, factorisation, point location, quadratic meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

#include "problems.h"
#include "statics/cholesky.h"
#include "statics/shape.h"

namespace pliant::statics_test {
namespace {

using Eigen::Vector3d;

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

TEST(Shape, RulesIntegrateMonomials) {
  for (const Element element : all_elements()) {
    for (const auto& [rule, degree] : {std::pair{&statics::quadrature(element), element == Element::tet4    ? 1
                                                                                : element == Element::tet10 ? 2
                                                                                                            : 3},
                                       {&statics::accurate_quadrature(element), 5}}) {
      for (int i = 0; i <= degree; ++i) {
        for (int j = 0; i + j <= degree; ++j) {
          for (int k = 0; i + j + k <= degree; ++k) {
            double sum = 0;
            for (const statics::LocalPoint& p : *rule)
              sum += p.weight * std::pow(p.at[0], i) * std::pow(p.at[1], j) * std::pow(p.at[2], k);
            const double exact = element == Element::hex8full
                                     ? 1.0 / ((i + 1) * (j + 1) * (k + 1))
                                     : factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
            EXPECT_NEAR(sum, exact, 1e-15) << statics::to_string(element) << " " << i << j << k;
          }
        }
      }
    }
  }
}

TEST(Shape, RulesOverTrianglesIntegrateMonomials) {
  for (const auto& [element, degree] : {std::pair{Element::tet4, 1}, {Element::tet10, 4}, {Element::hex8full, 4}}) {
    for (int i = 0; i <= degree; ++i) {
      for (int j = 0; i + j <= degree; ++j) {
        double sum = 0;
        for (const statics::FacePoint& p : statics::triangle_rule(element))
          sum += p.weight * std::pow(p.r, i) * std::pow(p.s, j);
        EXPECT_NEAR(sum, factorial(i) * factorial(j) / factorial(i + j + 2), 1e-15)
            << statics::to_string(element) << " " << i << j;
      }
    }
  }
}

TEST(Shape, FunctionsAreOneAtTheirNodeAndSumToOne) {
  for (const Element element : all_elements()) {
    const Mesh mesh = statics::box_mesh(element, {1, 1, 1}, {1, 1, 1});
    const statics::Field field(mesh);
    for (int a = 0; a < statics::corners_of(element); ++a) {
      std::vector<Vec3d> value(mesh.nodes.size());
      value[mesh.nodes_of(0)[a]] = {1, 0, 0};
      for (int b = 0; b < statics::corners_of(element); ++b) {
        statics::Place place = field.locate(mesh.nodes[mesh.nodes_of(0)[b]]);
        EXPECT_NEAR(field.value(place, value)[0], a == b ? 1 : 0, 1e-12);
      }
    }
  }
}

TEST(Cholesky, SolvesWhatADenseMethodSolvesAndSeesIndefiniteMatrices) {
  Problem p;
  p.mesh = distorted_box(Element::tet10, {5, 3, 3}, {0.5, 0.3, 0.3}, 0.2);
  p.materials = {physics::material(Law::neo_hookean, 1000, 3000)};
  statics::prescribe(
      p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
  statics::prescribe(
      p, [](const Vec3d& x) { return on(x[1], 0); }, 2);  // nodes with two unknowns
  const statics::System system(p, false);
  statics::SparseMatrix k = system.pattern();
  statics::Forces f;
  ASSERT_TRUE(system.tangent(Eigen::VectorXd::Zero(system.components()), 1, f, k));
  std::vector<int> node(system.unknowns());
  for (int i = 0; i < system.components(); ++i) {
    if (system.free_of()[i] >= 0) node[system.free_of()[i]] = i / 3;
  }
  statics::Cholesky cholesky;
  cholesky.analyze(k, node, p.mesh.nodes);
  const statics::SparseMatrix full = k.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd dense(full);
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(system.unknowns(), -1, 2);
  for (const double shift : {0.0, 300.0}) {
    ASSERT_TRUE(cholesky.factorize(k, shift));
    const Eigen::MatrixXd shifted = dense + shift * Eigen::MatrixXd::Identity(dense.rows(), dense.cols());
    const Eigen::VectorXd exact = shifted.llt().solve(right);
    EXPECT_LE((cholesky.solve(right) - exact).norm(), 1e-10 * exact.norm());
  }
  EXPECT_LT(cholesky.entries(), dense.size() / 3);
  EXPECT_FALSE(cholesky.factorize(k, -2 * dense.diagonal().minCoeff()));
  EXPECT_TRUE(cholesky.factorize(k, 0));
}

TEST(Dissection, GroupsHoldEveryNodeOnceAndChildrenDoNotTouch) {
  constexpr int n = 12;
  std::vector<std::vector<int>> neighbors(n * n * n);
  std::vector<Vec3d> position;
  for (int i = 0; i < n * n * n; ++i) {
    position.push_back({1.0 * (i % n), 1.0 * (i / n % n), 1.0 * (i / n / n)});
    for (int j = 0; j < i; ++j) {
      const Vec3d d = vec::sub(position[i], position[j]);
      if (std::abs(d[0]) <= 1 && std::abs(d[1]) <= 1 && std::abs(d[2]) <= 1) {
        neighbors[i].push_back(j);
        neighbors[j].push_back(i);
      }
    }
  }
  const statics::Dissection dissection = statics::dissect(neighbors, position);
  std::vector<int> group(n * n * n, -1);
  std::vector<int> parent(dissection.groups.size(), -1);
  for (std::size_t g = 0; g < dissection.groups.size(); ++g) {
    for (const int node : dissection.groups[g].nodes) {
      EXPECT_EQ(group[node], -1);
      group[node] = static_cast<int>(g);
    }
    for (const int c : dissection.groups[g].children) parent[c] = static_cast<int>(g);
  }
  EXPECT_EQ(std::count(group.begin(), group.end(), -1), 0);
  EXPECT_EQ(dissection.groups.back().nodes.size(), static_cast<std::size_t>(n * n));  // one plane
  const auto above = [&](int low, int high) {
    while (low >= 0 && low != high) low = parent[low];
    return low == high;
  };
  for (int i = 0; i < n * n * n; ++i) {
    for (const int j : neighbors[i]) EXPECT_TRUE(above(group[i], group[j]) || above(group[j], group[i]));
  }
}

TEST(Field, FindsPointsAndReproducesLinearFields) {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0; };
  for (const Element element : all_elements()) {
    const Mesh mesh = distorted_box(element, {5, 4, 3}, {0.5, 0.4, 0.3}, 0.3);
    const statics::Field field(mesh);
    std::vector<Vec3d> value;
    for (const Vec3d& x : mesh.nodes) value.push_back({x[0] + 2 * x[1], x[2], 1 - x[0]});
    for (int i = 0; i < 200; ++i) {
      const Vec3d x{0.5 * uniform(), 0.4 * uniform(), 0.3 * uniform()};
      const statics::Place place = field.locate(x);
      EXPECT_LE(place.outside, 1e-9);
      EXPECT_LE(vec::norm(vec::sub(field.value(place, value), {x[0] + 2 * x[1], x[2], 1 - x[0]})), 1e-12);
      EXPECT_NEAR(field.gradient(place, value)[1], 2, 1e-10);
    }
    // Outside: the nearest element's polynomial is continued.
    const Vec3d x{0.52, 0.2, 0.1};
    const statics::Place place = field.locate(x);
    EXPECT_GT(place.outside, 0.01);
    EXPECT_NEAR(field.value(place, value)[2], 1 - 0.52, 1e-10);
    double volume = 0;
    for (const statics::Sample& s : statics::samples(mesh)) volume += s.weight;
    EXPECT_NEAR(volume, 0.5 * 0.4 * 0.3, 1e-12);
  }
}

/// What is prescribed, by place, axis and displacement, all in steps of a nanometre.
std::multiset<std::array<std::int64_t, 5>> conditions_of(const Problem& p) {
  const auto steps = [](double x) { return static_cast<std::int64_t>(std::llround(x * 1e9)); };
  std::multiset<std::array<std::int64_t, 5>> all;
  for (const statics::Prescribed& c : p.prescribed) {
    const Vec3d& x = p.mesh.nodes[c.node];
    all.insert({steps(x[0]), steps(x[1]), steps(x[2]), c.axis, steps(c.displacement)});
  }
  return all;
}

TEST(Quadratic, KeepsNodesAndConditions) {
  Problem p;
  p.mesh = statics::box_mesh(Element::tet4, {2, 1, 1}, {0.2, 0.1, 0.1});
  p.materials = {physics::material(Law::neo_hookean, 1000, 3000)};
  statics::prescribe(
      p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
  statics::prescribe(p, [](const Vec3d& x) { return on(x[0], 0.2); }, 1, {0.01, 0, 0});
  const Problem q = statics::to_quadratic(p);
  EXPECT_EQ(q.mesh.element, Element::tet10);
  EXPECT_TRUE(std::equal(p.mesh.nodes.begin(), p.mesh.nodes.end(), q.mesh.nodes.begin()));
  Problem direct;
  direct.mesh = statics::box_mesh(Element::tet10, {2, 1, 1}, {0.2, 0.1, 0.1});
  statics::prescribe(
      direct, [](const Vec3d& x) { return on(x[0], 0); }, 7);
  statics::prescribe(direct, [](const Vec3d& x) { return on(x[0], 0.2); }, 1, {0.01, 0, 0});
  EXPECT_EQ(q.prescribed.size(), direct.prescribed.size());
  EXPECT_EQ(conditions_of(q), conditions_of(direct));
}

/// The middle of an edge moves by the mean of its ends, so that a linear field stays one.
TEST(Quadratic, PrescribesALinearFieldLinearly) {
  Problem p;
  p.mesh = statics::box_mesh(Element::tet4, {2, 1, 1}, {0.2, 0.1, 0.1});
  const auto field = [](const Vec3d& x, int axis) { return 0.01 + 0.1 * x[0] - 0.2 * x[1] + 0.3 * x[2] * (1 + axis); };
  for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      p.prescribed.push_back({static_cast<std::int32_t>(n), axis, field(p.mesh.nodes[n], axis)});
    }
  }
  const Problem q = statics::to_quadratic(p);
  EXPECT_EQ(q.prescribed.size(), 3 * q.mesh.nodes.size());
  for (const statics::Prescribed& c : q.prescribed) EXPECT_NEAR(c.displacement, field(q.mesh.nodes[c.node], c.axis), 1e-15);
}

}  // namespace
}  // namespace pliant::statics_test
