#include "scenes/generate/organs.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/distance.h"
#include "mesh_io/mesh_io.h"
#include "scenes/generate/hollow.h"
#include "surfaces.h"

namespace pliant {
namespace {

struct Expected {
  Vec3d extent;
  double volume;
  std::size_t least, most;  // vertices
};

const std::map<std::string, Expected> kExpected{
    {"apple", {{0.08, 0.07, 0.08}, 2.5e-4, 3000, 8000}},
    {"liver", {{0.22, 0.15, 0.12}, 1.6e-3, 3000, 8000}},
    {"kidney", {{0.06, 0.11, 0.05}, 1.8e-4, 3000, 8000}},
    {"beam", {{0.1, 0.02, 0.02}, 4e-5, 8, 1000}},
    {"cube", {{0.1, 0.1, 0.1}, 1e-3, 8, 1000}},
    {"block", {{0.12, 0.04, 0.08}, 3.84e-4, 8, 3000}},
    {"sheet", {{0.16, 0.008, 0.06}, 7.68e-5, 8, 2000}},
    {"tube", {{0.1, 0.048, 0.048}, 1.463e-4, 100, 3000}},
    {"cylinder", {{0.04, 0.1, 0.04}, 1.257e-4, 100, 3000}},
};

TEST(Organs, ClosedOutwardManifoldsOfTheirSize) {
  for (const std::string& name : shape_names()) {
    const Expected& expected = kExpected.at(name);
    const TriangleMesh mesh = make_shape(name);
    EXPECT_GE(mesh.vertices.size(), expected.least) << name;
    EXPECT_LE(mesh.vertices.size(), expected.most) << name;
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : mesh.triangles) {
      for (int e = 0; e < 3; ++e) ++edges[{t[e], t[(e + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << name;
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << name;
    }
    // Euler characteristic 2: one sphere, no handles; the tube is a torus.
    EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges.size() / 2 + (name == "tube" ? 0 : 2)) << name;
    EXPECT_NEAR(signed_volume(mesh), expected.volume, 0.02 * expected.volume) << name;
    vec::Box box;
    for (const Vec3d& v : mesh.vertices) box.extend(v);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(box.upper[a] - box.lower[a], expected.extent[a], 0.01 * expected.extent[a]) << name;
      EXPECT_NEAR(box.upper[a] + box.lower[a], 0, 1e-9) << name;
    }
  }
}

TEST(Organs, CheckedInFilesAreWhatTheGeneratorWrites) {
  for (const std::string& name : shape_names()) {
    const TriangleMesh made = make_shape(name), read = read_surface(test::shipped(name));
    EXPECT_EQ(made.triangles.size(), read.triangles.size()) << name;
    EXPECT_NEAR(signed_volume(made), signed_volume(read), 1e-5 * signed_volume(made)) << name;
  }
}

TEST(Organs, AHollowBodyIsClosedAndItsCavityTheWallAway) {
  constexpr double kWall = 0.01, kStep = 0.005;
  const TriangleMesh apple = make_shape("apple"), hollow = make_hollow(apple, kWall, kStep);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : hollow.triangles) {
    for (int e = 0; e < 3; ++e) ++edges[{t[e], t[(e + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
  EXPECT_EQ(hollow.vertices.size() + hollow.triangles.size(), edges.size() / 2 + 4);  // two spheres
  const SurfaceDistance distance(apple);
  ASSERT_GT(hollow.vertices.size(), apple.vertices.size());
  for (std::size_t v = apple.vertices.size(); v < hollow.vertices.size(); ++v) {
    EXPECT_TRUE(distance.inside(hollow.vertices[v]));
    EXPECT_NEAR(distance.closest(hollow.vertices[v]).distance, kWall, 0.1 * kStep);
  }
  EXPECT_LT(signed_volume(hollow), 0.8 * signed_volume(apple));
  EXPECT_NE(test::error_of([&] { make_hollow(apple, 0.05, kStep); }).find("too thin for its wall"), std::string::npos);
}

TEST(Organs, HollowLiverIsWhatTheGeneratorWrites) {
  const TriangleMesh made = make_hollow(make_shape("liver"), 0.012, 0.006), read = read_surface(test::shipped("hollow_liver"));
  EXPECT_EQ(made.triangles.size(), read.triangles.size());
  EXPECT_NEAR(signed_volume(made), signed_volume(read), 1e-5 * signed_volume(made));
}

TEST(Organs, UnknownNameAndUnwritableFile) {
  EXPECT_NE(test::error_of([] { make_shape("spleen"); }).find("no shape is called 'spleen'"), std::string::npos);
  EXPECT_NE(
      test::error_of([] { write_obj_text(make_shape("cube"), "", "/no/such/folder/cube.obj"); }).find("cannot be written"),
      std::string::npos);
}

}  // namespace
}  // namespace pliant
