// Surfaces as strangers make them: what is told, what is refused, what is mended.
#include "mesh_io/surface_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/distance.h"
#include "lattice/lattice.h"
#include "mesh_io/mesh_io.h"
#include "model/surface_check.h"
#include "surfaces.h"

namespace pliant {
namespace {

// A cube of edge 1 from n x n squares on each side; every cut of its grid is one of a cube moved by a multiple of 1 / n.
TriangleMesh cube(const Vec3d& low, int n) {
  TriangleMesh mesh;
  const auto vertex = [&](const std::array<int, 3>& at) {
    Vec3d p{};
    for (int a = 0; a < 3; ++a) p[a] = low[a] + static_cast<double>(at[a]) / n;
    mesh.vertices.push_back(p);
    return static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n * n; ++i) {
        std::array<std::int32_t, 4> v{};
        for (int c = 0; c < 4; ++c) {
          std::array<int, 3> at{};
          at[axis] = side;
          at[(axis + 1) % 3] = i % n + (c == 1 || c == 2 ? 1 : 0);
          at[(axis + 2) % 3] = i / n + (c >= 2 ? 1 : 0);
          v[c] = vertex(at);
        }
        if (side == 0) std::swap(v[1], v[3]);
        mesh.triangles.push_back({v[0], v[1], v[2]});
        mesh.triangles.push_back({v[0], v[2], v[3]});
      }
    }
  }
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

struct Checked {
  SurfaceReport report;
  TriangleMesh mesh;
  std::string refused, warnings;
  double filled = 0;
  std::size_t said = 0;
};

Checked checked(const TriangleMesh& raw, double spacing = 0.1) {
  Checked out;
  out.mesh = clean_surface(raw, "m", 1, {}, &out.report);
  out.refused = test::error_of([&] { require_inside(out.report); });
  if (!out.refused.empty()) return out;
  for (const Cell& c : build_lattice(out.mesh, {spacing, 0}).cells) out.filled += c.fill * std::pow(spacing, 3);
  for (const std::string& text : surface_warnings(out.report, crossings_of(out.mesh, out.report.shell), out.filled)) {
    out.warnings += text + "\n";
    ++out.said;
  }
  return out;
}

::testing::AssertionResult has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos ? ::testing::AssertionSuccess() : ::testing::AssertionFailure() << text;
}

TriangleMesh welded(const TriangleMesh& mesh) { return clean_surface(mesh, "m"); }

TEST(SurfaceReport, ASoundSurfaceIsSilent) {
  for (const char* name : {"apple", "liver", "kidney", "cylinder", "beam", "cube"}) {
    SurfaceReport report;
    const TriangleMesh mesh = read_surface(test::shipped(name), 1, {}, &report);
    require_inside(report);
    EXPECT_EQ(report.volume, signed_volume(mesh));
    EXPECT_TRUE(surface_warnings(report, crossings_of(mesh, report.shell), report.volume).empty()) << name;
  }
}

// The same volume wherever the second cube stands, and whichever way it is wound.
TEST(SurfaceReport, OverlappingCubesAreUnited) {
  for (const bool turned : {false, true}) {
    for (const Vec3d& at : {Vec3d{0.5, 0, 0}, Vec3d{0.5, 0.5, 0}, Vec3d{0.5, 0.5, 0.5}, Vec3d{0.53, 0.02, 0.01}}) {
      TriangleMesh both = cube({0, 0, 0}, 6);
      test::append(both, turned ? inside_out(cube(at, 6)) : cube(at, 6));
      const double united = 2 - (1 - at[0]) * (1 - at[1]) * (1 - at[2]);
      const Checked c = checked(welded(both));
      EXPECT_NEAR(c.filled, united, 0.005) << at[0] << ' ' << at[1] << ' ' << at[2] << ' ' << turned;
      EXPECT_TRUE(has(c.warnings, "the surface encloses 2 m^3")) << at[0] << ' ' << turned;
    }
  }
}

TEST(SurfaceReport, TouchingCubesAreBothThere) {
  TriangleMesh both = cube({0.1, 0.2, 0.3}, 4);
  test::append(both, cube({1.1, 0.2, 0.3}, 4));
  const Checked c = checked(welded(both));
  EXPECT_NEAR(c.filled, 2, 1e-9);
  EXPECT_EQ(c.report.flipped, 0);
  EXPECT_EQ(c.report.doubled, 32);
  EXPECT_EQ(c.report.doubled_dropped, 0);
}

TEST(SurfaceReport, CopiesAreDropped) {
  const TriangleMesh one = welded(cube({0, 0, 0}, 4));
  TriangleMesh twice = one, two_sided = one, some = one;
  test::append(twice, one);
  test::append(two_sided, inside_out(one));
  for (const std::size_t t : {7U, 30U, 31U}) some.triangles.push_back(one.triangles[t]);
  for (const auto& [mesh, copies] : {std::pair{twice, 192}, {two_sided, 192}, {some, 3}}) {
    const Checked c = checked(mesh);
    EXPECT_EQ(c.mesh.triangles.size(), one.triangles.size());
    EXPECT_EQ(c.report.doubled_dropped, copies);
    EXPECT_NEAR(c.filled, 1, 1e-9);
    EXPECT_TRUE(
        has(c.warnings, fmt::format("triangles in the place of another: {0}, of these dropped: {0}, the first at (", copies)));
  }
}

TEST(SurfaceReport, PointsAndTrianglesThatWereTakenAwayAreTold) {
  TriangleMesh mesh = welded(cube({0, 0, 0}, 2));
  mesh.vertices.push_back({1, 1, 0.5});  // there is one already
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({1, 1, 1});
  const Checked c = checked(mesh);
  EXPECT_EQ(c.report.merged, 1);
  EXPECT_EQ(c.report.degenerate, 2);
  EXPECT_EQ(c.said, 2U) << c.warnings;
  EXPECT_TRUE(has(c.warnings, "points in the place of another, merged with it: 1, the first at (1, 1, 0.5) m"));
  EXPECT_TRUE(has(c.warnings, "triangles without area, dropped: 2, the first at (0, "));
}

TEST(SurfaceReport, WrongWindingIsTold) {
  const TriangleMesh one = welded(cube({0, 0, 0}, 4));
  const Checked inward = checked(inside_out(one));
  EXPECT_TRUE(has(inward.warnings, "all 192 triangles were wound inward"));
  TriangleMesh some = one;
  for (const std::size_t t : {5U, 90U}) std::swap(some.triangles[t][1], some.triangles[t][2]);
  const Checked c = checked(some);
  EXPECT_TRUE(has(c.warnings, "triangles wound against the rest, turned round: 2 of 192, the first at "));
  EXPECT_NEAR(c.filled, 1, 1e-9);
}

TEST(SurfaceReport, SmallHolesAreToldAndClosed) {
  TriangleMesh mesh = welded(cube({0, 0, 0}, 8));
  const auto erase = [&](int axis, double side, double low, double high) {
    std::erase_if(mesh.triangles, [&](const auto& t) {
      for (const std::int32_t v : t) {
        for (int a = 0; a < 3; ++a) {
          const double x = mesh.vertices[v][a];
          if (a == axis ? x != side : x < low || x > high) return false;
        }
      }
      return true;
    });
  };
  erase(0, 1, 0.25, 0.75);  // a window of 4 x 4 squares, and one of 2 x 2
  erase(2, 0, 0.5, 0.75);
  const Checked c = checked(mesh);
  ASSERT_EQ(c.report.holes.size(), 2U);
  EXPECT_EQ(c.report.holes[0].edges, 16);
  EXPECT_EQ(c.report.holes[1].edges, 8);
  EXPECT_NEAR(c.report.hole_area(), 0.25 + 0.0625, 1e-12);
  EXPECT_NEAR(c.report.volume, 1, 1e-12);
  EXPECT_NEAR(c.filled, 1, 0.01);
  EXPECT_TRUE(has(c.warnings, "holes: 2, of 24 edges and 0.312 m^2 together"));
  EXPECT_TRUE(has(c.warnings, "is at (1, 0.5, 0.5) m"));
}

TEST(SurfaceReport, WhatHasNoInsideIsRefused) {
  const TriangleMesh whole = welded(cube({0, 0, 0}, 6));
  TriangleMesh half = whole, thinned = whole, flat;
  std::erase_if(half.triangles, [&](const auto& t) { return whole.vertices[t[0]][0] + whole.vertices[t[1]][0] > 0.9; });
  std::mt19937 random(3);
  std::erase_if(thinned.triangles, [&](const auto&) { return random() % 2 == 0; });
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const TriangleMesh& mesh : {half, thinned, flat}) {
    const std::string message = checked(mesh).refused;
    EXPECT_TRUE(has(message, "surface mesh 'm': has no inside to fill"));
    EXPECT_TRUE(has(message, "larger than 25 % of the part; close it in a mesh editor, or make it a sheet with \"thickness\""));
  }
  TriangleMesh folded = welded(cube({0, 0, 0}, 2));  // pressed flat: closed, but both sides coincide
  for (Vec3d& v : folded.vertices) v[1] *= 1e-9;
  EXPECT_TRUE(has(checked(folded).refused, "m^2 enclose "));
}

TEST(SurfaceReport, LooseSheetsAreToldAndNotFilled) {
  TriangleMesh mesh = welded(cube({0, 0, 0}, 6));
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0.5, 0.5, 0.5}, {3, 0.5, 0.5}, {3, 2, 0.5}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  const Checked c = checked(mesh);
  EXPECT_NEAR(c.filled, 1, 1e-9);
  EXPECT_EQ(c.report.sheet_triangles, 1);
  EXPECT_TRUE(c.report.holes.empty());
  EXPECT_TRUE(has(c.warnings, "triangles of open sheets that bound nothing: 1, the first at (2.16667, 1, 0.5) m"));
  // A wall inside the body, with all its rim on the skin.
  TriangleMesh walled = welded(cube({0, 0, 0}, 4));
  const TriangleMesh side = cube({0.25, 0, 0}, 4);
  TriangleMesh wall;
  wall.vertices = side.vertices;
  for (const auto& t : side.triangles) {
    if (side.vertices[t[0]][0] == 0.25 && side.vertices[t[1]][0] == 0.25 && side.vertices[t[2]][0] == 0.25)
      wall.triangles.push_back(t);
  }
  test::append(walled, wall);
  const Checked w = checked(walled);
  EXPECT_EQ(w.report.sheet_triangles, 32);
  EXPECT_NEAR(w.filled, 1, 1e-9);
}

TEST(Crossings, ArePairsOfTrianglesThatPassThroughEachOther) {
  TriangleMesh both = cube({0, 0, 0}, 3);
  test::append(both, cube({0.6, 0.55, 0.57}, 3));
  const Checked c = checked(welded(both));
  const Crossings found = crossings_of(c.mesh, c.report.shell);
  EXPECT_GT(found.pairs, 0);
  EXPECT_EQ(found.pairs, found.between_shells);
  EXPECT_EQ(found.searched, 1);
  // The place lies on both surfaces.
  for (const Vec3d& low : {Vec3d{0, 0, 0}, Vec3d{0.6, 0.55, 0.57}}) {
    EXPECT_NEAR(SurfaceDistance(test::box(low, vec::add(low, {1, 1, 1}))).closest(found.place).distance, 0, 1e-9);
  }
  const TriangleMesh apart = welded(cube({0, 0, 0}, 20));
  EXPECT_EQ(crossings_of(apart, std::vector<std::int32_t>(apart.triangles.size(), 0)).pairs, 0);
}

// So much work and no more, the same on every machine.
TEST(Crossings, TheSearchIsBounded) {
  const TriangleMesh mesh = test::sphere(1, 0.02);
  ASSERT_GT(mesh.triangles.size(), 20'000U);
  const std::vector<std::int32_t> shell(mesh.triangles.size(), 0);
  EXPECT_EQ(crossings_of(mesh, shell).searched, 1);
  const double cut = crossings_of(mesh, shell, 50'000).searched;
  EXPECT_GT(cut, 0);
  EXPECT_LT(cut, 0.5);
  SurfaceReport report;
  Crossings crossings;
  crossings.searched = cut;
  report.triangles = 1;
  EXPECT_TRUE(has(surface_warnings(report, crossings, 1).at(0), "was cut short after"));
}

TEST(SurfaceReport, TheModelHasTheWarnings) {
  Scene scene;
  Body body;
  body.name = "b";
  body.lattice.nodes = 9;
  body.surface_in_memory = std::make_shared<const TriangleMesh>(welded(cube({0, 0, 0}, 2)));
  scene.bodies = {body};
  std::vector<SurfaceCheck> checks;
  EXPECT_EQ(build_model(scene, checks).nodes(), 8);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].body, "b");
  ASSERT_EQ(checks[0].warnings.size(), 1U);
  EXPECT_EQ(checks[0].warnings[0], "\"lattice\" requests 9 nodes; the nearest lattice found has 8 (-11.1 %)");
}

}  // namespace
}  // namespace pliant
