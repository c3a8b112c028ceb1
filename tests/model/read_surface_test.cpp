#include <gtest/gtest.h>

#include "mesh_io/mesh_io.h"
#include "support/temp_folder.h"
#include "surfaces.h"

namespace pliant {
namespace {

class ReadSurface : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) { return folder_.write(name, text); }
  static std::string error(const std::filesystem::path& file) {
    return test::error_of([&] { read_surface(file); });
  }
  test::TempFolder folder_;
};

const char* const kTetra = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

bool mentions(const std::string& message, const std::string& words) { return message.find(words) != std::string::npos; }

TEST_F(ReadSurface, ObjScaledAndTranslated) {
  const TriangleMesh mesh = read_surface(write("t.obj", kTetra), 2, {1, 0, 0});
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(signed_volume(mesh), 8.0 / 6, 1e-12);
  double low = 9, high = -9;
  for (const Vec3d& v : mesh.vertices) {
    low = std::min(low, v[0]);
    high = std::max(high, v[0]);
  }
  EXPECT_EQ(low, 1);
  EXPECT_EQ(high, 3);
}

TEST_F(ReadSurface, QuadsAreSplitAndWoundOutward) {
  // The quad of the base is wound inward; the four sides outward.
  const TriangleMesh mesh = read_surface(
      write("p.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 1 2 3 4\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"));
  EXPECT_EQ(mesh.triangles.size(), 6U);
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 3, 1e-7);
}

TEST_F(ReadSurface, StlIsWelded) {
  std::string stl = "solid t\n";
  const double v[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int f[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& t : f) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int c : t) {
      stl += "vertex " + std::to_string(v[c][0]) + " " + std::to_string(v[c][1]) + " " + std::to_string(v[c][2]) + "\n";
    }
    stl += "endloop\nendfacet\n";
  }
  const TriangleMesh mesh = read_surface(write("t.stl", stl + "endsolid t\n"));
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 6, 1e-7);
}

TEST_F(ReadSurface, Ply) {
  const TriangleMesh mesh = read_surface(write(
      "t.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 6, 1e-7);
}

TEST_F(ReadSurface, GltfNodeTransformsApply) {
  // Three corners at 0, x, y as floats, indices 0 1 2 as shorts; the node doubles and shifts them.
  const std::string data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA=";
  const TriangleMesh mesh = read_surface(write("t.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0,"scale":[2,2,2],"translation":[0,0,5]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
      "buffers":[{"byteLength":44,"uri":"data:application/octet-stream;base64,)" +
                                                             data + "\"}]}"));
  ASSERT_EQ(mesh.vertices.size(), 3U);
  vec::Box box;
  for (const Vec3d& v : mesh.vertices) box.extend(v);
  EXPECT_EQ(box.upper, (Vec3d{2, 2, 5}));
  EXPECT_EQ(box.lower, (Vec3d{0, 0, 5}));
}

TEST_F(ReadSurface, DegenerateTrianglesAreDropped) {
  const TriangleMesh mesh = read_surface(write("t.obj", std::string(kTetra) + "v 2 0 0\nf 1 2 5\nf 1 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.vertices.size(), 4U);
}

TEST_F(ReadSurface, ErrorsSayWhatIsWrong) {
  EXPECT_TRUE(mentions(error(folder_.path() / "absent.obj"), "no such file"));
  EXPECT_TRUE(mentions(error(folder_.path()), "is a folder"));
  EXPECT_TRUE(mentions(error(write("empty.obj", "")), "is empty"));
  EXPECT_TRUE(mentions(error(write("text.obj", "nothing that could be a mesh, but long enough\n")), "text.obj"));
  EXPECT_TRUE(mentions(error(write("noise.stl", std::string(200, '\x7f'))), "cannot be read"));
  EXPECT_TRUE(mentions(error(write("t.unknown", "no format has this")), "cannot be read"));
  EXPECT_TRUE(mentions(error(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n")), "points.obj"));
  EXPECT_TRUE(mentions(error(write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\n")),
                       "all 2 triangles have zero area"));
  const std::string message = error(write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n"));
  EXPECT_TRUE(mentions(message, "vertex 2 (line 3): y is 'nan'")) << message;
  EXPECT_TRUE(mentions(error(write("word.obj", "v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n")), "vertex 1 (line 2): y is 'zero'"));
  EXPECT_TRUE(mentions(error(write("point.obj", "v 0 0 0\nv 1 -.5 0\nv 0 1 0\nf 1 2 3\n")),
                       "vertex 1 (line 2): y is '-.5'; a digit before the point is needed"));
  const std::string ply = error(
      write("nan.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n"));
  EXPECT_TRUE(mentions(ply, "nan.ply")) << ply;
  EXPECT_TRUE(mentions(test::error_of([&] { read_surface(write("t.obj", kTetra), 0); }), "scale is 0"));
}

TEST(Outside, RealMeshesAreRead) {
  for (const char* name : {"cow.obj", "suzanne.obj", "liver-smooth.obj", "stanford-bunny.obj"}) {
    const auto file = test::outside(name);
    if (file.empty()) GTEST_SKIP() << "the meshes for trials are absent (PLIANT_TEST_MESHES)";
    EXPECT_GT(signed_volume(read_surface(file)), 0) << name;
  }
}

TEST(Outside, ThreeDs) {
  const std::filesystem::path file = "/usr/share/glmark2/models/horse.3ds";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "glmark2-data is not installed";
  EXPECT_GT(read_surface(file).triangles.size(), 1000U);
}

}  // namespace
}  // namespace pliant
