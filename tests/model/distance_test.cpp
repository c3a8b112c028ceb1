#include "geometry/distance.h"

#include <gtest/gtest.h>

#include "geometry/band_distance.h"
#include "mesh_io/mesh_io.h"
#include "scenes/generate/organs.h"
#include "surfaces.h"

namespace pliant {
namespace {

double box_distance(const Vec3d& p, const Vec3d& half) {
  double out2 = 0, in = -HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    const double d = std::abs(p[a]) - half[a];
    out2 += d > 0 ? d * d : 0;
    in = std::max(in, d);
  }
  return in < 0 ? in : std::sqrt(out2);
}

TEST(Distance, BoxIsExact) {
  for (const DistanceEngine engine : {DistanceEngine::own, DistanceEngine::automatic}) {
    const SurfaceDistance distance(test::box({-1, -2, -0.5}, {1, 2, 0.5}), engine);
    std::mt19937 random(1);
    for (int n = 0; n < 2000; ++n) {
      const Vec3d p = test::random_point(random, {-4, -4, -4}, {4, 4, 4});
      EXPECT_NEAR(distance.signed_distance(p), box_distance(p, {1, 2, 0.5}), 1e-12);
    }
  }
}

TEST(Distance, SphereWithinItsFacets) {
  const SurfaceDistance distance(test::sphere(1, 0.1));
  std::mt19937 random(2);
  for (int n = 0; n < 2000; ++n) {
    const Vec3d p = test::random_point(random, {-2, -2, -2}, {2, 2, 2});
    EXPECT_NEAR(distance.signed_distance(p), vec::norm(p) - 1, 0.005);  // sagitta of a facet: 0.1^2 / 8 and a little
  }
}

TEST(Distance, EmbreeAgreesWithOwnTree) {
  if (!SurfaceDistance::has_embree()) GTEST_SKIP() << "this build has no Embree";
  TriangleMesh liver = make_shape("liver");
  for (Vec3d& v : liver.vertices) v[0] += 100;  // far from the origin, where floats are coarse
  const SurfaceDistance embree(liver, DistanceEngine::embree), own(liver, DistanceEngine::own);
  std::mt19937 random(3);
  for (int n = 0; n < 3000; ++n) {
    const Vec3d p = test::random_point(random, {99.6, -0.4, -0.4}, {100.4, 0.4, 0.4});
    const ClosestPoint a = embree.closest(p), b = own.closest(p);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.triangle, b.triangle);  // most of these points are nearest to an edge or a vertex, and so to several
    EXPECT_EQ(a.point, b.point);
    EXPECT_NEAR(vec::norm(vec::sub(a.point, p)), a.distance, 1e-12);
  }
}

TEST(Distance, TreeAgreesWithBruteForce) {
  const TriangleMesh mesh = test::sphere(1, 0.25);
  const TriangleTree tree(mesh);
  std::mt19937 random(4);
  for (int n = 0; n < 500; ++n) {
    const Vec3d p = test::random_point(random, {-2, -2, -2}, {2, 2, 2});
    double best = HUGE_VAL;
    for (const auto& t : mesh.triangles) {
      best = std::min(
          best, vec::norm(vec::sub(p, closest_on_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]))));
    }
    EXPECT_EQ(tree.closest(p).distance, best);
    EXPECT_EQ(tree.closest(p, 1.001 * best).triangle, tree.closest(p).triangle);
    EXPECT_EQ(tree.closest(p, 0.999 * best).triangle, -1);
    EXPECT_NEAR(tree.winding(p), vec::norm(p) < 1 ? 1 : 0, vec::norm(p) > 0.95 && vec::norm(p) < 1.05 ? 1 : 0.03);
  }
}

TEST(Orientation, RandomFlipsAreUndone) {
  const TriangleMesh good = test::sphere(1, 0.2);
  TriangleMesh bad = good;
  test::flip_some(bad, 0.4, 5);
  EXPECT_LT(signed_volume(bad), 0.8 * signed_volume(good));
  const OrientationReport report = orient_outward(bad);
  EXPECT_EQ(report.shells, 1);
  EXPECT_TRUE(report.closed());
  EXPECT_GT(report.flipped, 0);
  EXPECT_NEAR(signed_volume(bad), signed_volume(good), 1e-12);
}

TEST(Orientation, InwardMeshIsTurnedAndCavityStays) {
  TriangleMesh mesh = test::box({-2, -2, -2}, {2, 2, 2});
  TriangleMesh inner = test::box({-1, -1, -1}, {1, 1, 1});
  for (auto& t : inner.triangles) std::swap(t[1], t[2]);
  test::append(mesh, inner);
  for (const bool inverted : {false, true}) {
    TriangleMesh m = mesh;
    if (inverted) {
      for (auto& t : m.triangles) std::swap(t[1], t[2]);
    }
    const SurfaceDistance distance(m);
    EXPECT_FALSE(distance.inside({0, 0, 0}));
    EXPECT_TRUE(distance.inside({1.5, 0, 0}));
    EXPECT_NEAR(signed_volume(distance.mesh()), 64 - 8, 1e-12);
  }
}

TEST(Orientation, NestedBodiesWoundAlikeAreSolid) {
  TriangleMesh mesh = test::box({-2, -2, -2}, {2, 2, 2});
  test::append(mesh, test::box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_TRUE(SurfaceDistance(mesh).inside({0, 0, 0}));
}

TEST(Inside, HolesAndOverlaps) {
  TriangleMesh mesh = test::sphere(1, 0.1);
  // Cut a hole of radius 0.35 into the base.
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vec3d& v = mesh.vertices[t[0]];
    return v[1] < 0 && std::hypot(v[0], v[2]) < 0.35;
  });
  test::flip_some(mesh, 0.3, 6);
  TriangleMesh both = mesh;
  for (Vec3d& v : mesh.vertices) v[0] += 1;
  test::append(both, mesh);
  const SurfaceDistance distance(both);
  EXPECT_FALSE(distance.orientation().closed());
  std::mt19937 random(7);
  for (int n = 0; n < 3000; ++n) {
    const Vec3d p = test::random_point(random, {-2, -2, -2}, {3, 2, 2});
    const double d = std::min(vec::norm(p), vec::norm(vec::sub(p, {1, 0, 0}))) - 1;
    if (std::abs(d) < 0.02 || (p[1] < -0.6 && p[1] > -1.25)) continue;  // on the surface, or where the hole is closed
    EXPECT_EQ(distance.inside(p), d < 0) << p[0] << ' ' << p[1] << ' ' << p[2];
  }
}

TEST(Inside, BunnyWithHoles) {
  const auto open = test::outside("stanford-bunny.obj");
  for (const std::filesystem::path& file : {std::filesystem::path(test::kBunny), open}) {
    if (file.empty() || !std::filesystem::exists(file)) GTEST_SKIP() << "the bunny is not installed";
    TriangleMesh mesh = read_surface(file);
    vec::Box box;
    for (const Vec3d& v : mesh.vertices) box.extend(v);
    const double size = box.upper[1] - box.lower[1];
    test::flip_some(mesh, 0.2, 8);
    const SurfaceDistance distance(mesh);
    // Just beside the surface the side is known from the triangle; holes are avoided.
    std::mt19937 random(9);
    int tested = 0, right = 0;
    for (int n = 0; n < 4000; ++n) {
      const auto& t = distance.mesh().triangles[random() % mesh.triangles.size()];
      const Vec3d &a = distance.mesh().vertices[t[0]], &b = distance.mesh().vertices[t[1]], &c = distance.mesh().vertices[t[2]];
      const Vec3d normal = vec::cross(vec::sub(b, a), vec::sub(c, a)), centre = vec::mul(vec::add(a, vec::add(b, c)), 1.0 / 3);
      const Vec3d step = vec::mul(normal, 1e-5 * size / vec::norm(normal));
      if (distance.rim_distance(centre) < 0.03 * size) continue;
      right += distance.inside(vec::sub(centre, step)) && !distance.inside(vec::add(centre, step)) ? 1 : 0;
      ++tested;
    }
    EXPECT_GT(tested, 2000);
    EXPECT_GE(right, tested - 4);  // the scan has folds thinner than the step
    EXPECT_FALSE(distance.inside({box.lower[0], box.upper[1], box.lower[2]}));
    EXPECT_FALSE(distance.inside({box.upper[0] + size, 0, 0}));
  }
}

/// Two balls that overlap, on a grid with many cells beyond the band and inside.
TEST(Distance, BandOnAGridIsExactAndTheRestIsNear) {
  TriangleMesh mesh = test::sphere(1, 0.2), other = test::sphere(0.7, 0.2);
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vec3d& v : other.vertices) mesh.vertices.push_back({v[0] + 1.2, v[1] + 0.1, v[2] - 0.2});
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const NodeGrid grid{{-1.62, -1.57, -1.51}, 0.11, {34, 29, 28}};
  const std::vector<double> got = band_distances(mesh, grid);
  ASSERT_EQ(got.size(), static_cast<std::size_t>(grid.nodes()));
  const SurfaceDistance exact(mesh);
  int inside = 0, far = 0;
  for (std::size_t n = 0; n < got.size(); ++n) {
    const auto i = static_cast<std::int64_t>(n);
    const Vec3d p{grid.origin[0] + static_cast<double>(i % 34) * grid.spacing,
                  grid.origin[1] + static_cast<double>(i / 34 % 29) * grid.spacing,
                  grid.origin[2] + static_cast<double>(i / 34 / 29) * grid.spacing};
    const double distance = exact.signed_distance(p);
    inside += distance < 0 ? 1 : 0;
    ASSERT_EQ(got[n] < 0, distance < 0) << n;
    if (std::abs(distance) <= 2 * grid.spacing) {
      ASSERT_NEAR(got[n], distance, 1e-12) << n;
    } else {
      ++far;
      ASSERT_GE(got[n], distance - grid.spacing) << n;
      ASSERT_LE(got[n], distance + 1e-12) << n;
    }
  }
  EXPECT_GT(inside, 3000);
  EXPECT_GT(far, 10000);
}

/// A box whose faces, edges and diagonals lie on rows of the grid: every row must still cross it as often in as out.
TEST(Distance, BandSignsOnRowsAlongEdges) {
  const TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
  const NodeGrid grid{{-2, -2, -2}, 0.25, {17, 17, 17}};
  const std::vector<double> got = band_distances(mesh, grid);
  for (std::size_t n = 0; n < got.size(); ++n) {
    const Vec3d p{-2 + 0.25 * static_cast<double>(n % 17), -2 + 0.25 * static_cast<double>(n / 17 % 17),
                  -2 + 0.25 * static_cast<double>(n / 17 / 17)};
    const double exact = box_distance(p, {1, 1, 1});
    if (exact == 0) {
      EXPECT_EQ(got[n], 0) << n;
    } else {
      EXPECT_EQ(got[n] < 0, exact < 0) << n;
    }
  }
}

TEST(Distance, ErrorsSayWhatIsWrong) {
  EXPECT_NE(test::error_of([] { SurfaceDistance(TriangleMesh{}); }).find("no triangles"), std::string::npos);
}

}  // namespace
}  // namespace pliant
