// Ways over a triangle mesh, told from vertex to vertex.
#include "geometry/surface_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "support/source_dir.h"
#include "support/unit_ball.h"

namespace pliant {
namespace {

/// A sheet of cells x cells squares of the side 1, each of two triangles, bent by `place`.
template <class Place>
TriangleMesh sheet(int cells, Place&& place) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) mesh.vertices.push_back(place(i, j));
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = i + (cells + 1) * j, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

SurfacePoint on(const SurfaceWalk& walk, const Vec3d& p) {
  const ClosestPoint c = walk.closest(p);
  return {c.triangle, c.point};
}

double length(const std::vector<WayPart>& way) {
  double sum = 0;
  for (const WayPart& part : way) sum += vec::norm(vec::sub(part.to, part.from));
  return sum;
}

std::vector<std::int32_t> names(const std::vector<VertexOnWay>& vertices) {
  std::vector<std::int32_t> all;
  for (const VertexOnWay& v : vertices) all.push_back(v.vertex);
  return all;
}

/// The vertices in contact along a straight line from `from` to `to`, walked in `steps` steps.
std::vector<std::int32_t> walked(const SurfaceWalk& walk, const Vec3d& from, const Vec3d& to, int steps) {
  SurfacePoint at = on(walk, from);
  std::vector<std::int32_t> all{walk.vertex_at(at)};
  for (int i = 1; i <= steps; ++i) {
    const SurfacePoint next = on(walk, vec::add(from, vec::mul(vec::sub(to, from), static_cast<double>(i) / steps)));
    const auto way = walk.way(at, next, 10 * vec::norm(vec::sub(next.at, at.at)));
    EXPECT_TRUE(way.has_value());
    for (const VertexOnWay& v : walk.vertices(way.value_or(std::vector<WayPart>{}), all.back())) {
      const auto far = [&](std::int32_t n) {
        return vec::norm(vec::sub(walk.mesh().vertices[static_cast<std::size_t>(n)], v.at));
      };
      EXPECT_NEAR(far(v.vertex), far(all.back()), 1e-6) << "it changes where both are as near";
      all.push_back(v.vertex);
    }
    at = next;
  }
  return all;
}

/// The same by looking for the nearest of all vertices at many places.
std::vector<std::int32_t> nearest(const TriangleMesh& mesh, const Vec3d& from, const Vec3d& to) {
  std::vector<std::int32_t> all;
  for (int i = 0; i <= 20000; ++i) {
    const Vec3d p = vec::add(from, vec::mul(vec::sub(to, from), i / 20000.0));
    const auto closer = [&](const Vec3d& a, const Vec3d& b) { return vec::norm(vec::sub(a, p)) < vec::norm(vec::sub(b, p)); };
    const auto best = std::min_element(mesh.vertices.begin(), mesh.vertices.end(), closer) - mesh.vertices.begin();
    if (all.empty() || all.back() != best) all.push_back(static_cast<std::int32_t>(best));
  }
  return all;
}

/// Straight lines over a plane, slowly, fast, and in one step: the vertex in contact is the nearest of all.
TEST(SurfaceWalk, TellsTheNearestVerticesOfALine) {
  const SurfaceWalk walk(sheet(12, [](int i, int j) { return Vec3d{1.0 * i, 1.0 * j, 0}; }));
  const std::vector<std::array<Vec3d, 2>> lines{{Vec3d{0.6, 3.3, 0}, Vec3d{11.2, 3.3, 0}},
                                                {Vec3d{0.4, 0.7, 0}, Vec3d{11.3, 9.1, 0}},
                                                {Vec3d{10.9, 0.2, 0}, Vec3d{1.1, 11.6, 0}},
                                                {Vec3d{2, 1, 0}, Vec3d{2, 9, 0}}};
  for (const auto& [from, to] : lines) {
    const std::vector<std::int32_t> expected = nearest(walk.mesh(), from, to);
    EXPECT_GT(expected.size(), 8U);
    for (const int steps : {1, 7, 500}) EXPECT_EQ(walked(walk, from, to, steps), expected) << steps << " steps";
  }
}

/// A point that rests between two vertices, up to rounding, stays with one of them.
TEST(SurfaceWalk, DoesNotFlickerBetweenTwoVertices) {
  const SurfaceWalk walk(sheet(12, [](int i, int j) { return Vec3d{1.0 * i, 1.0 * j, 0}; }));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-1e-12, 1e-12);
  SurfacePoint at = on(walk, {4.5, 4.2, 0});
  std::int32_t vertex = walk.vertex_at(at);
  int changes = 0;
  for (int i = 1; i <= 1000; ++i) {
    const SurfacePoint next = on(walk, {4.5 + noise(random), 4.2 + noise(random), 0});
    const auto way = walk.way(at, next, 1);
    ASSERT_TRUE(way.has_value());
    for (const std::int32_t v : names(walk.vertices(*way, vertex))) vertex = v, ++changes;
    at = next;
  }
  EXPECT_LE(changes, 1);
}

/// The walls of a valley are near each other, and the way from one to the other is long.
TEST(SurfaceWalk, DoesNotJumpAcrossAFold) {
  const auto valley = [](int i, int j) {  // down a wall, a cell along the bottom, up the other wall, which leans away a little
    const double y = i <= 10 ? 10 - i : i == 11 ? -0.5 : i - 12;
    return Vec3d{i <= 10 ? 0 : i == 11 ? 0.5 : 1 + 0.02 * y, y, 1.0 * j};
  };
  const SurfaceWalk walk(sheet(22, valley));
  const SurfacePoint here = on(walk, {0, 6.2, 5.3}), there = on(walk, {1.13, 6.4, 5.3}), beside = on(walk, {0, 7.9, 5.3});
  const auto straight = [&](const SurfacePoint& to) { return vec::norm(vec::sub(to.at, here.at)); };
  EXPECT_TRUE(walk.way(here, beside, 2 * straight(beside)).has_value());
  EXPECT_FALSE(walk.way(here, there, 2 * straight(there)).has_value());
  const auto around = walk.way(here, there, 100);
  ASSERT_TRUE(around.has_value());
  EXPECT_NEAR(length(*around), 6.2 + 2 * std::sqrt(0.5) + 6.4, 0.05);
}

/// On a ball the way is a great circle, and the shorter part of it.
TEST(SurfaceWalk, IsAGreatCircleOfABall) {
  const SurfaceWalk walk(test::unit_ball(64));
  std::mt19937 random(2);
  std::normal_distribution<double> any;
  for (int n = 0; n < 200; ++n) {
    Vec3d a{any(random), any(random), any(random)}, b{any(random), any(random), any(random)};
    a = vec::mul(a, 1 / vec::norm(a));
    b = vec::mul(b, 1 / vec::norm(b));
    const double angle = std::acos(vec::dot(a, b));
    if (angle > 3) continue;  // nearly opposite points have no shortest way
    const auto way = walk.way(on(walk, a), on(walk, b), 10);
    ASSERT_TRUE(way.has_value());
    EXPECT_NEAR(length(*way), angle, 0.02 * angle + 0.01);
  }
}

/// The shipped liver: the vertices of a way are the nearest of those in whose 1-ring its points lie, wherever it is looked at.
TEST(SurfaceWalk, TellsTheVerticesOfACurvedBody) {
  const SurfaceWalk walk(read_surface(test::source_dir() + "/scenes/meshes/liver.obj"));
  const TriangleMesh& mesh = walk.mesh();
  const TriangleTree tree(mesh);
  const auto corner_at = [&](const Vec3d& p) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(tree.closest(p).triangle)];
    const auto far = [&](std::int32_t v) { return vec::norm(vec::sub(mesh.vertices[static_cast<std::size_t>(v)], p)); };
    return *std::min_element(t.begin(), t.end(), [&](std::int32_t a, std::int32_t b) { return far(a) < far(b); });
  };
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> any(0, mesh.vertices.size() - 1);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  int ways = 0;
  std::size_t told = 0, brief = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3d p = mesh.vertices[any(random)];
    const SurfacePoint from = on(walk, vec::add(p, {0.0003, 0.0002, 0.0001}));
    const SurfacePoint to = on(walk, vec::add(p, {shift(random), shift(random), shift(random)}));
    const auto way = walk.way(from, to, 2 * vec::norm(vec::sub(to.at, from.at)));
    if (!way) continue;
    ++ways;
    const std::vector<VertexOnWay> vertices = walk.vertices(*way, walk.vertex_at(from));
    std::vector<std::int32_t> all{walk.vertex_at(from)}, sampled;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double until = i + 1 < vertices.size() ? vertices[i + 1].share : 1;
      if (until - vertices[i].share < 2e-3) {  // samples may pass over it
        ++brief;
        continue;
      }
      if (vertices[i].vertex != all.back()) all.push_back(vertices[i].vertex);
    }
    const double whole = length(*way);
    for (const WayPart& part : *way) {
      const int parts = 1 + static_cast<int>(2000 * vec::norm(vec::sub(part.to, part.from)) / whole);
      for (int i = 0; i < parts; ++i) {
        const Vec3d at = vec::add(part.from, vec::mul(vec::sub(part.to, part.from), (i + 0.5) / parts));
        const std::int32_t v = corner_at(at);
        const bool known = std::find(all.begin(), all.end(), v) != all.end();
        if (known && (sampled.empty() || sampled.back() != v)) sampled.push_back(v);
      }
    }
    EXPECT_EQ(sampled, all);
    told += all.size() - 1;
  }
  EXPECT_GT(ways, 150);
  EXPECT_GT(told, 500U);
  EXPECT_LT(brief, told / 20);
}

}  // namespace
}  // namespace pliant
