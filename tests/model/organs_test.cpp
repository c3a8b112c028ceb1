#include "scenes/generate/organs.h"

#include <gtest/gtest.h>

#include <map>

#include "mesh_io/mesh_io.h"
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
    // Euler characteristic 2: one sphere, no handles.
    EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges.size() / 2 + 2) << name;
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

TEST(Organs, UnknownNameAndUnwritableFile) {
  EXPECT_NE(test::error_of([] { make_shape("spleen"); }).find("no shape is called 'spleen'"), std::string::npos);
  EXPECT_NE(
      test::error_of([] { write_obj_text(make_shape("cube"), "", "/no/such/folder/cube.obj"); }).find("cannot be written"),
      std::string::npos);
}

}  // namespace
}  // namespace pliant
