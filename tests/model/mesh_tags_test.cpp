// The tags of cells in files that this test writes, and the regions that selections make of them.
#include "mesh_io/mesh_tags.h"

#include <gtest/gtest.h>

#include <random>

#include "mesh_io/mesh_io.h"
#include "model/elements/body_mesh.h"
#include "model/volume_files.h"
#include "pliant/error.h"
#include "scene/mesh_region.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using Found = std::vector<std::array<std::int64_t, 3>>;  // dimension, place, number

Found found(const MeshTags::Array* array) {
  Found out;
  if (array == nullptr) return out;
  for (const MeshTags::Tag& t : array->tags) out.push_back({t.dimension, t.place, t.number});
  return out;
}

class TagsOfFormat : public ::testing::TestWithParam<testing::VolumeFile> {};

TEST_P(TagsOfFormat, HasItsTags) {
  const test::TempFolder folder;
  MeshTags tags;
  const auto file = folder.write("m" + GetParam().extension, GetParam().content);
  const VolumeMesh mesh = read_volume(file, 1, {}, &tags);
  ASSERT_EQ(mesh.tets.size(), 2u);
  ASSERT_EQ(mesh.hexes.size(), 1u);
  // Tetrahedra are 0 and 1, the hexahedron is 2; the triangle lies on the first tetrahedron.
  EXPECT_EQ(found(tags.find("")), (Found{{3, 0, 5}, {3, 1, 5}, {3, 2, 3}, {2, 0, 7}}));
  const bool gmsh = GetParam().extension == ".msh";
  const Found entities{{3, 0, 2}, {3, 1, 2}, {3, 2, 1}, {2, 0, 1}};
  EXPECT_EQ(found(tags.find(gmsh ? "gmsh:geometrical" : "part of")), entities);
  EXPECT_EQ(tags.find("a"), nullptr) << "numbers that are not whole are no tags";
  EXPECT_EQ(tags.find("materialids"), nullptr) << "a name that is given has to be the array's";
  if (GetParam().name != "gmsh1") {
    ASSERT_NE(tags.values_of("a"), nullptr);
    EXPECT_EQ(tags.values_of("a")->of, (std::vector<double>{2, 2.25, 1.5}));
  }
  EXPECT_EQ(tags.values_of("v"), nullptr) << "a vector";
  ASSERT_EQ(tags.faces.size(), 1u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh.vertices.at(tags.faces[0][k]), testing::kPoints[9 + k]);
  EXPECT_EQ(tags.faces[0][3], -1);
}

TEST_P(TagsOfFormat, SurvivesDamage) {
  const test::TempFolder folder;
  std::mt19937 random(11);
  int errors = 0;
  const auto attempt = [&](const std::string& content) {
    const auto file = folder.write("m" + GetParam().extension, content);
    try {
      MeshTags tags;
      const VolumeMesh mesh = read_volume(file, 1, {}, &tags);
      for (const MeshTags::Array& array : tags.arrays) {
        for (const MeshTags::Tag& t : array.tags)
          ASSERT_LT(static_cast<std::size_t>(t.place),
                    t.dimension == 3 ? mesh.tets.size() + mesh.hexes.size() : tags.faces.size());
      }
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::bad_input) << e.what();
      ++errors;
    }
  };
  const std::string& good = GetParam().content;
  for (int trial = 0; trial < 200; ++trial) {
    std::string content = good;
    for (int k = 0; k < 3; ++k)
      content[random() % content.size()] = static_cast<char>(random() % 3 == 0 ? '9' : random() % 256);
    attempt(content);
    attempt(good.substr(0, good.size() * static_cast<std::size_t>(trial) / 200));
  }
  EXPECT_GT(errors, 100);
}

INSTANTIATE_TEST_SUITE_P(MeshTags, TagsOfFormat, ::testing::ValuesIn(testing::volume_files(true)),
                         [](const auto& test) { return test.param.name; });

TEST(MeshTags, OfTetgenAreTheFirstAttribute) {
  const test::TempFolder folder;
  (void)folder.write("m.node", testing::tetgen_node(1));
  MeshTags tags;
  (void)read_volume(folder.write("m.ele", testing::tetgen_ele(1)), 1, {}, &tags);
  EXPECT_EQ(found(tags.find("region")), (Found{{3, 0, 7}, {3, 1, 7}}));
}

TEST(MeshTags, NamesAndCounts) {
  const test::TempFolder folder;
  for (const std::string& content : {testing::gmsh2_text(), testing::gmsh4_text(true)}) {
    MeshTags tags;
    (void)read_volume(folder.write("m.msh", content), 1, {}, &tags);
    EXPECT_EQ(MeshTags::listed(tags.regions(*tags.find(""))),
              "3 (1 element), 5 \"a tumour\" (2 elements), 7 \"skin\" (1 face)");
    EXPECT_EQ(MeshTags::listed(tags.regions(*tags.find("gmsh:geometrical"))), "1 (1 element), 2 (2 elements), 1 (1 face)");
  }
}

/// A bar of four unit cells along x, six tetrahedra each; the last two are the tumour, the face at x = 4 is "end". Every
/// element of the third cell is written once more for the group "both", which holds the whole bar's third quarter.
std::string bar() {
  std::string nodes, elements;
  int count = 0;
  for (int x = 0; x < 5; ++x) {
    for (int c = 0; c < 4; ++c)
      nodes += std::to_string(4 * x + c + 1) + " " + std::to_string(x) + " " + std::to_string(c & 1) + " " +
               std::to_string(c >> 1) + "\n";
  }
  const auto add = [&](int type, int tag, const std::vector<int>& of) {
    elements += std::to_string(++count) + " " + std::to_string(type) + " 2 " + std::to_string(tag) + " 1";
    for (const int n : of) elements += " " + std::to_string(n + 1);
    elements += "\n";
  };
  // Along the six ways from one corner of the cell to the opposite one; x is the slowest axis of the numbers.
  const int paths[6][3] = {{4, 1, 2}, {4, 2, 1}, {1, 4, 2}, {1, 2, 4}, {2, 4, 1}, {2, 1, 4}};
  for (int pass = 0; pass < 2; ++pass) {
    for (int cell = pass == 0 ? 0 : 2; cell < (pass == 0 ? 4 : 3); ++cell) {
      for (const auto& path : paths) {
        std::vector<int> of{4 * cell};
        for (const int step : path) of.push_back(of.back() + step);
        const bool odd = (path[0] == 4 && path[1] == 2) || (path[0] == 1 && path[1] == 4) || (path[0] == 2 && path[1] == 1);
        if (odd) std::swap(of[2], of[3]);
        add(4, pass == 1 ? 8 : cell < 2 ? 1 : 2, of);
      }
    }
  }
  add(2, 2, {16, 17, 19});
  add(2, 2, {16, 19, 18});
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 2 \"tumour\"\n3 8 \"both\"\n2 2 "
         "\"end\"\n$EndPhysicalNames\n"
         "$Nodes\n20\n" +
         nodes + "$EndNodes\n$Elements\n" + std::to_string(count) + "\n" + elements + "$EndElements\n";
}

RegionName named(const char* name, int dimension = 0) { return {name, 0, "", dimension}; }
RegionName numbered(std::int64_t number, int dimension = 0, const char* data = "") { return {"", number, data, dimension}; }

class TaggedRegions : public ::testing::Test {
 protected:
  TaggedRegions()
      : file_(folder_.write("bar.msh", bar())), mesh_(std::make_shared<const TaggedMesh>(file_, 2, Vec3d{0, 0, 1})) {}
  [[nodiscard]] MeshRegion region(const RegionName& name, Selected of) const { return {mesh_, name, of, "/here/region"}; }
  /// The places [m] of the body along x where the region holds a node.
  [[nodiscard]] std::vector<double> planes(const RegionName& name) const {
    const MeshRegion r = region(name, Selected::nodes);
    const VolumeMesh mesh = read_volume(file_, 2, {0, 0, 1});
    std::vector<double> out;
    for (std::size_t n = 0; n < mesh.vertices.size(); n += 4) {
      for (std::size_t k = 1; k < 4; ++k)
        EXPECT_EQ(r.contains(mesh.vertices[n], static_cast<std::int64_t>(n)),
                  r.contains(mesh.vertices[n + k], static_cast<std::int64_t>(n + k)));
      if (r.contains(mesh.vertices[n], static_cast<std::int64_t>(n))) out.push_back(mesh.vertices[n][0]);
    }
    return out;
  }
  [[nodiscard]] std::string refusal(const RegionName& name, Selected of) const {
    try {
      (void)region(name, of).contains({}, 0);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::bad_input);
      return e.what();
    }
    return "";
  }
  test::TempFolder folder_;
  std::filesystem::path file_;
  std::shared_ptr<const TaggedMesh> mesh_;
};

TEST_F(TaggedRegions, OfNodesAreThoseOfTheirCells) {
  EXPECT_EQ(planes(named("tumour")), (std::vector<double>{4, 6, 8}));
  EXPECT_EQ(planes(numbered(2, 3)), (std::vector<double>{4, 6, 8}));
  EXPECT_EQ(planes(numbered(1)), (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(planes(named("both")), (std::vector<double>{4, 6}));
  EXPECT_EQ(planes(named("end")), (std::vector<double>{8}));
  EXPECT_EQ(planes(numbered(2, 2)), (std::vector<double>{8}));
  EXPECT_EQ(planes(numbered(1, 3, "gmsh:geometrical")), (std::vector<double>{0, 2, 4, 6, 8}));
}

TEST_F(TaggedRegions, AreFoundByPlaceWhereNumbersDoNotHold) {
  const MeshRegion nodes = region(named("tumour"), Selected::nodes);
  EXPECT_TRUE(nodes.contains({8, 2, 3}, 4711));
  EXPECT_TRUE(nodes.contains({8, 2, 3 + 1e-9}, 0));
  EXPECT_FALSE(nodes.contains({2, 2, 3}, 4711));
  EXPECT_FALSE(nodes.contains({8, 2, 3 + 1e-6}, 4711));
}

TEST_F(TaggedRegions, OfElementsAndTriangles) {
  const VolumeMesh mesh = read_volume(file_, 2, {0, 0, 1});
  ASSERT_EQ(mesh.tets.size(), 24u);
  const MeshRegion elements = region(numbered(2), Selected::elements);
  const auto middle = [&](const auto& of) {
    Vec3d x{};
    for (const std::int32_t v : of) {
      for (int a = 0; a < 3; ++a) x[a] += mesh.vertices[v][a] / static_cast<double>(of.size());
    }
    return x;
  };
  for (std::size_t e = 0; e < 24; ++e) {
    const Vec3d x = middle(mesh.tets[e]);
    EXPECT_EQ(elements.contains(x, static_cast<std::int64_t>(e)), x[0] > 4);
    EXPECT_EQ(elements.contains(x, 99), x[0] > 4);
  }
  const MeshRegion end = region(named("end"), Selected::triangles), skin = region(named("tumour"), Selected::triangles);
  int on_end = 0, on_tumour = 0;
  std::int64_t t = 0;
  for (const auto& triangle : boundary_triangles(mesh)) {
    const Vec3d x = middle(triangle);
    on_end += end.contains(x, t) ? 1 : 0;
    EXPECT_EQ(end.contains(x, t), x[0] > 7.99);
    on_tumour += skin.contains(x, t) ? 1 : 0;
    EXPECT_EQ(skin.contains(x, t), x[0] > 4);
    ++t;
  }
  EXPECT_EQ(on_end, 2);
  EXPECT_EQ(on_tumour, 2 + 2 * 8);
}

TEST_F(TaggedRegions, ThatAreNotThereAreRefusedWithThoseThatAre) {
  const std::string all =
      "expected one of 1 (12 elements), 2 \"tumour\" (12 elements), 8 \"both\" (6 elements), 2 \"end\" (2 faces)";
  for (const RegionName& name : {numbered(3), named("liver"), named("tumour", 2)}) {
    const std::string text = refusal(name, Selected::nodes);
    EXPECT_NE(text.find("/here/region: got "), std::string::npos) << text;
    EXPECT_NE(text.find(all), std::string::npos) << text;
    EXPECT_NE(text.find(file_.string()), std::string::npos) << text;
  }
  EXPECT_NE(refusal(named("end"), Selected::elements).find("no such region of elements"), std::string::npos);
  const std::string twice = refusal(numbered(2), Selected::nodes);
  EXPECT_NE(twice.find("2 \"tumour\" (12 elements), 2 \"end\" (2 faces)"), std::string::npos) << twice;
  EXPECT_NE(twice.find("\"dimension\": 2 (faces) or 3 (elements)"), std::string::npos) << twice;
  const std::string array = refusal(numbered(2, 0, "part"), Selected::nodes);
  EXPECT_NE(array.find("\"gmsh:physical\", \"gmsh:geometrical\", expected an array \"part\""), std::string::npos) << array;
}

TEST_F(TaggedRegions, OfAFileWithoutTags) {
  const auto file = folder_.write("m.vtk", testing::vtk_legacy(false, false));
  const MeshRegion r(std::make_shared<const TaggedMesh>(file, 1, Vec3d{}), numbered(1), Selected::nodes, "/here/region");
  try {
    (void)r.contains({}, 0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("the numbers of cells in " + file.string() +
                                         " are \"a\", expected one of the usual names (gmsh:physical"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace pliant
