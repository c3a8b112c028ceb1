#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "io/obj.h"
#include "io/vtu.h"
#include "mesh_io/mesh_io.h"
#include "pliant/error.h"
#include "support/temp_folder.h"

namespace pliant::writers_test {
namespace {

using test::bytes_of;
using test::TempFolder;

VtuMesh sample() {
  VtuMesh m;
  m.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},   {0, 0, 1},    {1, 0, 1},
              {1, 1, 1}, {0, 1, 1}, {3, 0, 0}, {4.5, 0, 0}, {3, 1.25, 0}, {3, 0, 2}};
  m.hexes = {{0, 1, 2, 3, 4, 5, 6, 7}};
  m.tets = {{8, 9, 10, 11}};
  m.triangles = {{8, 10, 9}};
  VtuArray u{"displacement", 3, {}};
  VtuArray s{"a<b>&\"c\"", 1, {}};
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 3; ++k) u.values.push_back(static_cast<float>(i) + 0.25f * static_cast<float>(k));
    s.values.push_back(static_cast<float>(-i));
  }
  m.point_arrays = {u, s};
  m.cell_arrays = {{"energy", 1, {10, 20, 30}}};
  return m;
}

TEST(WriteVtu, IsReadBack) {
  const TempFolder folder;
  write_vtu(folder.path() / "m.vtu", sample());
  const VolumeMesh m = read_volume(folder.path() / "m.vtu");
  EXPECT_EQ(m.vertices, sample().points);  // all of them are exact in float
  EXPECT_EQ(m.tets, sample().tets);
  EXPECT_EQ(m.hexes, sample().hexes);
}

/// Value `index` of the array of that name (as the XML spells it), found by the offset that the head gives.
float appended_float(const std::string& text, const std::string& name, std::size_t index) {
  const std::size_t tag = text.find("Name=\"" + name + "\"");
  const std::size_t offset = std::stoul(text.substr(text.find("offset=\"", tag) + 8));
  const std::size_t start = text.find('_', text.find("<AppendedData")) + 1;
  float value = 0;
  std::memcpy(&value, text.data() + start + offset + 8 + 4 * index, 4);
  return value;
}

TEST(WriteVtu, ArraysStandWhereTheHeadSays) {
  const TempFolder folder;
  write_vtu(folder.path() / "m.vtu", sample());
  const std::string text = bytes_of(folder.path() / "m.vtu");
  EXPECT_EQ(appended_float(text, "displacement", 3 * 11 + 2), 11.5f);
  EXPECT_EQ(appended_float(text, "a&lt;b&gt;&amp;&quot;c&quot;", 5), -5.0f);
  EXPECT_EQ(appended_float(text, "energy", 2), 30.0f);
}

TEST(WriteVtu, LargeMeshCrossesTheBlocks) {
  const TempFolder folder;
  VtuMesh m;
  for (int i = 0; i < 5000; ++i) {
    const double x = 2 * i;
    const auto n = static_cast<std::int32_t>(m.points.size());
    m.points.insert(m.points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}});
    m.tets.push_back({n, n + 1, n + 2, n + 3});
  }
  write_vtu(folder.path() / "m.vtu", m);
  const VolumeMesh r = read_volume(folder.path() / "m.vtu");
  EXPECT_EQ(r.vertices, m.points);
  EXPECT_EQ(r.tets, m.tets);
}

TEST(WriteVtu, RefusesWhatDoesNotFit) {
  const TempFolder folder;
  VtuMesh m = sample();
  m.point_arrays[0].values.pop_back();
  EXPECT_THROW(write_vtu(folder.path() / "m.vtu", m), Error);
  m = sample();
  m.tets[0][2] = 12;
  EXPECT_THROW(write_vtu(folder.path() / "m.vtu", m), Error);
  m = sample();
  m.cell_arrays[0].components = 2;
  EXPECT_THROW(write_vtu(folder.path() / "m.vtu", m), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "m.vtu"));
}

TEST(PvdSeries, GrowsByFrames) {
  const TempFolder folder;
  PvdSeries series(folder.path() / "run.pvd");
  series.append(0, folder.path() / "run_0.vtu");
  EXPECT_NE(bytes_of(folder.path() / "run.pvd").find("</VTKFile>"), std::string::npos);
  series.append(0.1, folder.path() / "frames" / "run_1.vtu");
  const std::string text = bytes_of(folder.path() / "run.pvd");
  EXPECT_NE(text.find("timestep=\"0\" group=\"\" part=\"0\" file=\"run_0.vtu\""), std::string::npos) << text;
  EXPECT_NE(text.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"frames/run_1.vtu\""), std::string::npos) << text;
  EXPECT_EQ(series.size(), 2u);
}

TEST(WriteObj, IsReadBack) {
  const TempFolder folder;
  const float third = 1.0f / 3.0f;
  const TriangleMesh m{{{third, 0, 0}, {1, -2e-7f, 0}, {0, 1, 0}, {0, 0, 1e10f}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  write_obj(folder.path() / "m.obj", m, std::vector<Vec3d>(4, {0, 0, 1}));
  std::ifstream in(folder.path() / "m.obj");
  TriangleMesh r;
  std::size_t normals = 0;
  for (std::string line; std::getline(in, line);) {
    std::replace(line.begin(), line.end(), '/', ' ');
    std::istringstream s(line);
    std::string key;
    s >> key;
    Vec3d v{};
    std::array<std::int32_t, 6> f{};
    if (key == "v" && s >> v[0] >> v[1] >> v[2]) r.vertices.push_back(v);
    if (key == "vn") ++normals;
    if (key == "f" && s >> f[0] >> f[1] >> f[2] >> f[3] >> f[4] >> f[5]) r.triangles.push_back({f[0] - 1, f[2] - 1, f[4] - 1});
  }
  EXPECT_EQ(normals, 4u);
  EXPECT_EQ(r.triangles, m.triangles);
  ASSERT_EQ(r.vertices.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(static_cast<float>(r.vertices[i][k]), static_cast<float>(m.vertices[i][k]));
  }
  write_obj(folder.path() / "bare.obj", m);
  const std::string text = bytes_of(folder.path() / "bare.obj");
  EXPECT_NE(text.find("\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"), std::string::npos) << text;
  EXPECT_THROW(write_obj(folder.path() / "n.obj", m, {{0, 0, 1}}), Error);
  ObjCorners corners{{{0, 0, 1}}, {{0.25F, 0.5F}}, {}, {}, {}};
  EXPECT_THROW(write_textured_obj(folder.path() / "t.obj", m, corners), Error) << "no entry per triangle";
  corners.normal_of.assign(m.triangles.size(), {0, 0, 0});
  corners.texture_of = corners.normal_of;
  corners.cut.assign(m.triangles.size(), 0);
  corners.cut[0] = 1;
  write_textured_obj(folder.path() / "t.obj", m, corners);
  const std::string textured = bytes_of(folder.path() / "t.obj");
  EXPECT_NE(textured.find("vt 0.25 0.5\nvn 0 0 1\ng skin\n"), std::string::npos) << textured;
  EXPECT_LT(textured.find("g skin"), textured.find("g cut"));
  corners.texture_of[0][1] = 1;
  EXPECT_THROW(write_textured_obj(folder.path() / "t.obj", m, corners), Error) << "one coordinate";
  EXPECT_THROW(write_obj(folder.path() / "n.obj", {m.vertices, {{0, 1, 4}}}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "n.obj"));
}

}  // namespace
}  // namespace pliant::writers_test
