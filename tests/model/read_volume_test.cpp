#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "mesh_io/mesh_io.h"
#include "mesh_io/read_volume_parts.h"
#include "pliant/error.h"
#include "support/error_of.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"
#include "volume_files.h"

namespace pliant {
namespace {

using test::TempFolder;
using testing::VolumeFile;

double tet_volume(const VolumeMesh& m, const std::array<std::int32_t, 4>& t) {
  const auto& o = m.vertices[static_cast<std::size_t>(t[0])];
  double d[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) d[i][k] = m.vertices[static_cast<std::size_t>(t[i + 1])][k] - o[k];
  }
  return (d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) - d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
          d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) /
         6;
}

double total_volume(const VolumeMesh& m) {
  double v = 0;
  for (const auto& t : m.tets) v += tet_volume(m, t);
  return v;
}

TriangleMesh boundary(const VolumeMesh& m) { return {m.vertices, boundary_triangles(m)}; }

double enclosed(const TriangleMesh& m) {
  double v = 0;
  for (const auto& t : m.triangles) {
    const auto& a = m.vertices[static_cast<std::size_t>(t[0])];
    const auto& b = m.vertices[static_cast<std::size_t>(t[1])];
    const auto& c = m.vertices[static_cast<std::size_t>(t[2])];
    v += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  return v;
}

/// The message of the Error that reading gives; fails the test when there is none.
std::string error_of(const std::filesystem::path& file) {
  const std::string message = test::error_of([&] { read_volume(file); });
  EXPECT_NE(message, "") << "no error";
  return message;
}

void expect_error(const std::filesystem::path& file, std::initializer_list<const char*> parts) {
  const std::string message = error_of(file);
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A build without zlib refuses compressed files with a message, which is no failure.
bool without_zlib(const std::string& message) { return message.find("no zlib") != std::string::npos; }

class EveryFormat : public ::testing::TestWithParam<VolumeFile> {};

TEST_P(EveryFormat, GivesTheMesh) {
  const TempFolder folder;
  const auto file = folder.write("mesh" + GetParam().extension, GetParam().content);
  VolumeMesh m;
  try {
    m = read_volume(file, 2.0, {1, 0, 0});
  } catch (const Error& e) {
    if (without_zlib(e.what())) GTEST_SKIP() << e.what();
    throw;
  }
  ASSERT_EQ(m.vertices.size(), 13u);  // the unused one is gone
  ASSERT_EQ(m.hexes.size(), 1u);
  ASSERT_EQ(m.tets.size(), 2u);
  for (std::size_t i = 0; i < 13; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(m.vertices[i][k], 2 * testing::kPoints[i + 1][k] + (k == 0 ? 1 : 0));
  }
  EXPECT_EQ(m.hexes[0], (std::array<std::int32_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(m.tets[0], (std::array<std::int32_t, 4>{8, 9, 10, 11}));
  EXPECT_EQ(m.tets[1], (std::array<std::int32_t, 4>{9, 12, 10, 11}));
}

TEST_P(EveryFormat, SurvivesTruncation) {
  const TempFolder folder;
  const std::string& content = GetParam().content;
  std::size_t errors = 0;
  std::size_t tries = 0;
  for (std::size_t n = 0; n < content.size(); n += 10, ++tries) {
    const auto file = folder.write("mesh" + GetParam().extension, content.substr(0, n));
    try {
      EXPECT_EQ(read_volume(file).tets.size(), 2u) << n;
    } catch (const Error& e) {
      ++errors;
      EXPECT_EQ(e.code(), ErrorCode::bad_input) << e.what();
    }
  }
  EXPECT_GT(errors, tries / 2);
}

TEST_P(EveryFormat, SurvivesDamage) {
  const TempFolder folder;
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::string content = GetParam().content;
    for (int k = 0; k < 3; ++k)
      content[random() % content.size()] = static_cast<char>(random() % 3 == 0 ? '9' : random() % 256);
    const auto file = folder.write("mesh" + GetParam().extension, content);
    try {
      const VolumeMesh m = read_volume(file);
      for (const auto& t : m.tets) EXPECT_GT(tet_volume(m, t), 0);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::bad_input) << e.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ReadVolume, EveryFormat, ::testing::ValuesIn(testing::volume_files()),
                         [](const auto& test) { return test.param.name; });

TEST(ReadVolumeTetgen, ReadsBothBasesThroughEitherName) {
  for (const int base : {0, 1}) {
    const TempFolder folder;
    const auto node = folder.write("m.node", testing::tetgen_node(base));
    const auto ele = folder.write("m.ele", testing::tetgen_ele(base));
    for (const auto& file : {node, ele}) {
      const VolumeMesh m = read_volume(file);
      ASSERT_EQ(m.tets.size(), 2u);
      EXPECT_EQ(m.vertices.size(), 5u);
      EXPECT_EQ(m.vertices[0], testing::kPoints[9]);
      EXPECT_EQ(m.tets[1], (std::array<std::int32_t, 4>{1, 4, 2, 3}));
    }
  }
}

TEST(ReadVolumeTetgen, SurvivesTruncation) {
  const TempFolder folder;
  const std::string node = testing::tetgen_node(1);
  const std::string ele = testing::tetgen_ele(1);
  for (std::size_t n = 0; n < node.size(); n += 10) {
    const auto file = folder.write("m.node", node.substr(0, n));
    for (std::size_t k = 0; k < ele.size(); k += 10) {
      EXPECT_EQ(folder.write("m.ele", ele.substr(0, k)).extension(), ".ele");
      // Only the closing comments may be missing.
      const bool complete = n > node.find("# end") - 3 && k > ele.find("# end") - 3;
      try {
        EXPECT_EQ(read_volume(file).tets.size(), 2u);
        EXPECT_TRUE(complete) << n << " " << k;
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ErrorCode::bad_input) << e.what();
      }
    }
  }
}

TEST(ReadVolumeTetgen, MissingPartnerIsNamed) {
  const TempFolder folder;
  expect_error(folder.write("m.node", testing::tetgen_node(1)), {"m.ele", "no such file"});
}

TEST(ReadVolume, ErrorsSayWhere) {
  const TempFolder folder;
  const auto msh = [&](const std::string& text) { return folder.write("a.msh", text); };
  const std::string good = testing::gmsh2_text();
  // Line 7 announces the section, 8 the number of nodes, 9 to 22 hold them.
  expect_error(msh(replaced(good, "2 0 0 0\n", "2 0 zero 0\n")), {"a.msh:12:", "coordinate", "zero"});
  expect_error(msh(replaced(good, "3 4 2 5 2 10 11 12 13", "3 4 2 5 2 10 11 12 99")), {"element 3", "node 99"});
  expect_error(msh(replaced(good, "2 0 0 0\n", "2 0 nan 0\n")), {"vertex 2", "nan"});
  expect_error(msh(replaced(good, "\n14\n", "\n1400000000000\n")), {"a.msh:10:", "1400000000000", "cannot fit"});
  expect_error(msh(replaced(good, "\n14\n", "\n-3\n")), {"-3"});
  expect_error(msh(replaced(good, "2.2 0 8", "3.5 0 8")), {"3.5", "4.1"});
  expect_error(msh(replaced(good, "\n2 0 0 0\n", "\n1 0 0 0\n")), {"node 1 appears twice"});
  expect_error(msh(replaced(good, "\n14\n", "\n13\n")), {"$EndNodes"});
  expect_error(msh("hello"), {"a.msh:1:", "$MeshFormat"});
  expect_error(folder.write("a.vtk", replaced(testing::vtk_legacy(false, false), "4 9 10 11 12", "4 9 10 11 77")),
               {"cell 2", "point 77"});
  expect_error(folder.write("a.vtk", replaced(testing::vtk_legacy(false, false), "UNSTRUCTURED_GRID", "POLYDATA")),
               {"a.vtk:4:", "polydata"});
  expect_error(folder.write("a.vtu", replaced(testing::vtu({}), "9 10 11 12", "9 10 11 -1")), {"cell 2", "-1"});
  expect_error(folder.write("a.vtu", replaced(testing::vtu({}), "connectivity", "connexion")), {"connectivity", "missing"});
  expect_error(folder.write("a.vtu", "<VTKFile"), {"a.vtu:1:", "XML"});
  testing::VtuVariant packed;
  packed.where = testing::VtuVariant::Where::raw;
  packed.compressed = true;
  expect_error(folder.write("a.vtu", replaced(testing::vtu(packed), "vtkZLib", "vtkLZ4")), {"vtkLZ4", "vtkZLib"});
  // Text is never compressed, whatever the head says.
  EXPECT_EQ(read_volume(folder.write("a.vtu", replaced(testing::vtu({}), " byte_order",
                                                       " compressor=\"vtkLZ4DataCompressor\" byte_order")))
                .tets.size(),
            2u);
}

TEST(ReadVolume, RefusesWhatIsNoMeshFile) {
  const TempFolder folder;
  expect_error(folder.path() / "absent.msh", {"absent.msh", "no such file"});
  expect_error(folder.path(), {"extension"});
  expect_error(folder.write("a.xyz", "1"), {".xyz", ".msh"});
  expect_error(folder.write("a.msh", ""), {"empty"});
  std::filesystem::create_directory(folder.path() / "d.msh");
  expect_error(folder.path() / "d.msh", {"not a file"});
  EXPECT_THROW(read_volume(folder.write("b.msh", testing::gmsh2_text()), 0.0), Error);
}

TEST(ReadVolume, NamesWhatItFoundInsteadOfCells) {
  const TempFolder folder;
  std::string text = testing::gmsh2_text();
  text = text.substr(0, text.find("$Elements")) + "$Elements\n2\n1 2 0 1 2 3\n2 1 0 4 5\n$EndElements\n";
  expect_error(folder.write("a.msh", text), {"14 vertices", "1 triangles", "1 lines"});
  text = testing::gmsh2_text();
  text = text.substr(0, text.find("$Elements")) + "$Elements\n1\n5 6 0 1 2 3 4 5 6\n$EndElements\n";
  expect_error(folder.write("a.msh", text), {"element 5", "prisms"});
}

TEST(ReadVolume, OrientationOfTetrahedra) {
  const TempFolder folder;
  const std::string good = testing::gmsh2_text();
  const std::string one = replaced(good, "4 4 2 5 2 11 14 12 13", "4 4 2 5 2 14 11 12 13");
  expect_error(folder.write("a.msh", one), {"tetrahedron 4", "inverted", "-2.14583", "1 of 2"});
  const auto both = folder.write("a.msh", replaced(one, "3 4 2 5 2 10 11 12 13", "3 4 2 5 2 11 10 12 13"));
  const VolumeMesh flipped = read_volume(both);
  for (const auto& t : flipped.tets) EXPECT_GT(tet_volume(flipped, t), 0);
  EXPECT_NEAR(total_volume(flipped), total_volume(read_volume(folder.write("b.msh", good))), 1e-14);
  expect_error(folder.write("a.msh", replaced(good, "3 4 2 5 2 10 11 12 13", "3 4 2 5 2 10 11 12 12")),
               {"tetrahedron 3", "no volume"});
}

TEST(ReadVolume, OrientationOfHexahedra) {
  const TempFolder folder;
  const std::string good = testing::gmsh2_text();
  const VolumeMesh m = read_volume(folder.write("a.msh", replaced(good, "2 3 4 5 6 7 8 9", "6 7 8 9 2 3 4 5")));
  EXPECT_EQ(m.hexes[0], (std::array<std::int32_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}));
  // The order of a voxel, x fastest, in a hexahedron.
  expect_error(folder.write("a.msh", replaced(good, "2 3 4 5 6 7 8 9", "2 3 5 4 6 7 9 8")), {"hexahedron 1"});
  std::string voxel = replaced(testing::vtk_legacy(false, false), "8 1 2 3 4 5 6 7 8", "8 1 2 4 3 5 6 8 7");
  EXPECT_EQ(read_volume(folder.write("a.vtk", replaced(voxel, "\n12 5 10", "\n11 5 10"))).hexes, m.hexes);
}

TEST(ReadVolume, SecondOrderCellsGiveTheirCorners) {
  const TempFolder folder;
  std::string text = testing::gmsh2_text();
  text = text.substr(0, text.find("$Elements")) + "$Elements\n1\n1 11 0 10 11 12 13 1 2 3 4 5 6\n$EndElements\n";
  const VolumeMesh m = read_volume(folder.write("a.msh", text));
  ASSERT_EQ(m.tets.size(), 1u);
  EXPECT_EQ(m.vertices.size(), 4u);
  EXPECT_NEAR(total_volume(m), 1.5 * 1.25 * 2 / 6, 1e-15);
}

TEST(ReadVolume, RepeatedElementsCountOnce) {
  const TempFolder folder;
  const std::string text = replaced(testing::gmsh2_text(), "$Elements\n4\n", "$Elements\n5\n9 4 2 2 1 10 11 12 13\n");
  const VolumeMesh m = read_volume(folder.write("a.msh", text));
  EXPECT_EQ(m.tets.size(), 2u);
}

/// Every edge is used once in each direction.
bool closed(const TriangleMesh& m) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> balance;
  for (const auto& t : m.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = t[k];
      const auto b = t[(k + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

TEST(BoundaryTriangles, EnclosesTheVolumeOutwards) {
  const TempFolder folder;
  const VolumeMesh m =
      read_volume(folder.write("a.msh", testing::gmsh2_text()), 1.0, {5, 6, 7});  // no face in a plane through the origin
  const TriangleMesh b = boundary(m);
  EXPECT_EQ(b.triangles.size(), 12u + 6u);  // six quadrilaterals split in two; two tetrahedra share one of eight faces
  EXPECT_TRUE(closed(b));
  EXPECT_NEAR(enclosed(b), 1 + total_volume(m), 1e-12);
}

TEST(ShippedMeshes, FillTheirBoxes) {
  const std::filesystem::path meshes = std::filesystem::path(test::source_dir()) / "scenes" / "meshes";
  const VolumeMesh beam = read_volume(meshes / "beam_tet.msh");
  EXPECT_EQ(beam.tets.size(), 1080u);
  EXPECT_NEAR(total_volume(beam), 0.1 * 0.02 * 0.02, 1e-12);
  const TriangleMesh b = boundary(beam);
  EXPECT_EQ(b.triangles.size(), 2u * (2 * 9 + 4 * 60));
  EXPECT_TRUE(closed(b));
  EXPECT_NEAR(enclosed(b), 0.1 * 0.02 * 0.02, 1e-12);
  const VolumeMesh cube = read_volume(meshes / "cube_tet.vtu");
  EXPECT_EQ(cube.tets.size(), 384u);
  EXPECT_NEAR(total_volume(cube), 1e-3, 1e-11);
}

TEST(RealMeshes, AreReadAndClosed) {
  const char* set = std::getenv("PLIANT_TEST_MESHES");
  const std::filesystem::path folder =
      set != nullptr ? std::filesystem::path(set) : std::filesystem::path(test::source_dir()) / ".." / "shared" / "meshes";
  if (!std::filesystem::exists(folder / "liver-tetra.msh")) {
    GTEST_SKIP() << "real meshes are absent; set PLIANT_TEST_MESHES to their folder";
  }
  for (const char* name : {"liver-tetra.msh", "torus-tetra.msh"}) {
    const VolumeMesh m = read_volume(folder / name);
    const TriangleMesh b = boundary(m);
    EXPECT_GT(m.tets.size(), 500u) << name;
    EXPECT_TRUE(closed(b)) << name;
    EXPECT_NEAR(enclosed(b) / total_volume(m), 1, 1e-9) << name;
    std::printf("%s: %zu vertices, %zu tetrahedra, %zu boundary triangles, volume %.6g\n", name, m.vertices.size(),
                m.tets.size(), b.triangles.size(), enclosed(b));
  }
}

}  // namespace
}  // namespace pliant
