// Homogeneous states with closed forms, for every element and law, to 1e-10; and what a problem without an answer gets.
#include "problems.h"
#include "support/error_of.h"

namespace pliant::statics_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using physics::first_piola;

const Vec3d kSize{0.2, 0.1, 0.1};

Problem box(Element element, Law law) {
  Problem p;
  p.mesh = distorted_box(element, {3, 2, 2}, kSize, 0.2);
  p.materials = {physics::material(law, 1000, 4000)};
  return p;
}

/// Sum of the reactions at x = size, over the rest area: the first Piola-Kirchhoff stress P_xx.
double pull(const Problem& p, const Solution& s) {
  double sum = 0;
  for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) {
    if (on(p.mesh.nodes[n][0], kSize[0])) sum += s.reaction[n][0];
  }
  return sum / (kSize[1] * kSize[2]);
}

template <class Body>
void each(const Body& body) {
  for (const Element element : all_elements()) {
    for (const Law law : all_laws()) {
      SCOPED_TRACE(std::string(statics::to_string(element)) + " " + to_string(law));
      body(element, law);
    }
  }
}

TEST(Exact, UniaxialStretch) {
  each([](Element element, Law law) {
    Problem p = box(element, law);
    for (int c = 0; c < 3; ++c)
      statics::prescribe(
          p, [c](const Vec3d& x) { return on(x[c], 0); }, 1 << c);
    statics::prescribe(p, [](const Vec3d& x) { return on(x[0], kSize[0]); }, 1, {0.3 * kSize[0], 0, 0});
    const Solution s = solved(p);
    const auto f = [](double side) { return Matrix3d(Vector3d(1.3, side, side).asDiagonal()); };
    const double side = physics::root(0.5, 1.2, [&](double t) { return first_piola(f(t), p.materials[0])(1, 1); });
    const double miss = largest_miss(p, s, [&](const Vector3d& x) { return ((f(side) - Matrix3d::Identity()) * x).eval(); });
    EXPECT_LE(miss, 1e-10 * kSize[0]);
    EXPECT_NEAR(pull(p, s) / first_piola(f(side), p.materials[0])(0, 0), 1, 1e-9);
    EXPECT_LE(s.residual, 1e-10);
  });
}

TEST(Exact, ConfinedColumnUnderTraction) {
  each([](Element element, Law law) {
    Problem p = box(element, law);
    for (int c = 0; c < 3; ++c)
      statics::prescribe(
          p, [c](const Vec3d& x) { return on(x[c], 0) || (c > 0 && on(x[c], kSize[c])); }, 1 << c);
    const auto f = [](double t) { return Matrix3d(Vector3d(t, 1, 1).asDiagonal()); };
    const double t = law == Law::saint_venant_kirchhoff ? 0.95 : 0.8;  // this law soon loses stability in compression
    const double stress = first_piola(f(t), p.materials[0])(0, 0);
    const double area = statics::add_traction(p, [](const Vec3d& x) { return on(x[0], kSize[0]); }, {stress, 0, 0});
    EXPECT_NEAR(area, kSize[1] * kSize[2], 1e-15);
    const Solution s = solved(p);
    EXPECT_LE(largest_miss(p, s, [t](const Vector3d& x) { return Vector3d((t - 1) * x[0], 0, 0); }), 1e-10 * kSize[0]);
  });
}

TEST(Exact, ShearOfADistortedMeshWithItsBoundaryMoved) {
  each([](Element element, Law law) {
    Problem p = box(element, law);
    const auto exact = [](const Vector3d& x) { return Vector3d(0.5 * x[1], 0.1 * x[2], 0); };
    for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) {
      const Vector3d u = exact(eigen(p.mesh.nodes[n]));
      for (int c = 0; on_boundary(p.mesh.nodes[n], kSize) && c < 3; ++c)
        p.prescribed.push_back({static_cast<std::int32_t>(n), c, u[c]});
    }
    const Solution s = solved(p);
    EXPECT_GT(s.unknowns, 0);
    EXPECT_LE(largest_miss(p, s, exact), 1e-10 * kSize[0]);
    // What is moved is on the right side of the first equation: one solve has it all.
    Settings linear;
    linear.linear = true;
    const Solution one = solved(p, linear);
    EXPECT_EQ(one.iterations(), 1);
    EXPECT_LE(largest_miss(p, one, exact), 1e-10 * kSize[0]);
  });
}

TEST(Exact, ClosedSurfaceUnderPressureShrinksEvenly) {
  for (const Law law : all_laws()) {  // over linear triangles: other faces share the force out otherwise
    SCOPED_TRACE(to_string(law));
    Problem p = box(Element::tet4, law);
    const auto f = [](double t) { return Matrix3d(t * Matrix3d::Identity()); };
    const double t = law == Law::saint_venant_kirchhoff ? 0.97 : 0.9;
    const double cauchy = first_piola(f(t), p.materials[0])(0, 0) / (t * t);
    for (int c = 0; c < 3; ++c)
      statics::prescribe(
          p, [c](const Vec3d& x) { return on(x[c], 0); }, 1 << c);
    // The boundary's triangles as a surface of nodes.
    VolumeMesh mesh;
    mesh.vertices = p.mesh.nodes;
    for (std::int64_t e = 0; e < p.mesh.elements(); ++e) {
      const std::int32_t* const c = p.mesh.nodes_of(e);
      mesh.tets.push_back({c[0], c[1], c[2], c[3]});
    }
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
      statics::SurfacePoint point{mesh.vertices[n], {}, {1}};
      point.nodes.fill(static_cast<std::int32_t>(n));
      p.surface.push_back(point);
    }
    for (const auto& triangle : boundary_triangles(mesh)) p.pressures.push_back({triangle, -cauchy});
    const Solution s = solved(p);
    EXPECT_LE(largest_miss(p, s, [&](const Vector3d& x) { return ((t - 1) * x).eval(); }), 1e-10 * kSize[0]);
    EXPECT_LE(s.iterations(), 8);
  }
}

TEST(Exact, LinearSolveIsOneIterationAndProportional) {
  each([](Element element, Law law) {
    Problem p = box(element, law);
    statics::prescribe(
        p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
    p.gravity = {0, -3, 0};
    Settings linear;
    linear.linear = true;
    const Solution one = solved(p, linear);
    p.gravity = {0, -3000, 0};
    const Solution thousand = solved(p, linear);
    EXPECT_EQ(one.iterations(), 1);
    EXPECT_NEAR(thousand.displacement.back()[1] / one.displacement.back()[1], 1000, 1e-7);
    double work = 0;
    for (std::size_t n = 0; n < p.mesh.nodes.size(); ++n) work += one.reaction[n][1];
    EXPECT_NEAR(work, 3 * 1000 * kSize[0] * kSize[1] * kSize[2], 1e-9);  // the wall carries the weight
  });
}

TEST(Exact, ProblemsWithoutAnAnswerAreRefused) {
  Problem p = box(Element::tet4, Law::neo_hookean);
  EXPECT_NE(test::error_of([&] { statics::solve(p); }).find("may still move as a rigid body"), std::string::npos);
  statics::prescribe(
      p, [](const Vec3d& x) { return on(x[0], 0) && on(x[1], 0); }, 7);  // an edge is a hinge
  EXPECT_NE(test::error_of([&] { statics::solve(p); }).find("may still move as a rigid body"), std::string::npos);
  statics::prescribe(
      p, [](const Vec3d& x) { return on(x[0], 0); }, 7);
  EXPECT_TRUE(statics::solve(p).converged);
  p.forces.push_back({1000000, {}});
  EXPECT_NE(test::error_of([&] { statics::solve(p); }).find("a force names node 1000000"), std::string::npos);
}

TEST(Exact, WhatCannotConvergeIsReportedWithTheLastState) {
  Problem p = box(Element::hex8full, Law::saint_venant_kirchhoff);  // collapses in compression at a finite stress
  for (int c = 0; c < 3; ++c)
    statics::prescribe(
        p, [c](const Vec3d& x) { return on(x[c], 0) || (c > 0 && on(x[c], kSize[c])); }, 1 << c);
  statics::add_traction(p, [](const Vec3d& x) { return on(x[0], kSize[0]); }, {-1e5, 0, 0});
  const Solution s = statics::solve(p);
  EXPECT_FALSE(s.converged);
  EXPECT_FALSE(s.failure.empty());
  EXPECT_LT(s.load, 1);
  EXPECT_EQ(s.displacement.size(), p.mesh.nodes.size());
}

}  // namespace
}  // namespace pliant::statics_test
