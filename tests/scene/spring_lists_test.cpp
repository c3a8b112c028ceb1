// The key "springs" of a body, in scene files, in files of their own and in code: each mistake gets one message, and what is
// written is read again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pliant/scene.h"
#include "scene/patched_scene.h"
#include "scene/spec.h"
#include "support/temp_folder.h"

namespace pliant::spring_lists_scene_test {
namespace {

using Json = nlohmann::json;
using model_test::schema;

Json skin() {
  return Json::parse(R"({"format": "pliant-scene/1", "bodies": [
    {"name": "a", "surface": "a.obj", "thickness": 0.002, "material": {"young": 3000, "poisson": 0.25},
     "springs": [{"nodes": [[0, 1], [1, 2, 2.5], [2, 0, 1, 0.03]], "spring": {"stiffness": 4}}]}]})");
}

TEST(SceneSpringLists, EachMistakeHasOneMessage) {
  ASSERT_EQ(model_test::message(skin().dump()), "");
  EXPECT_TRUE(schema().findings(skin()).empty());
  struct Mistake {
    const char *pointer, *value, *expected;
    bool in_schema;
  };
  for (const Mistake& m : std::vector<Mistake>{
           {"/springs/0/nodes", "[]", "/springs/0/nodes: got [], expected a list of at least one row of nodes", true},
           {"/springs/0/nodes", "[[0]]", "/springs/0/nodes/0: got [0], expected a row [from, to], [from, to, factor] or", true},
           {"/springs/0/nodes", "[[0, 1, 1, 1, 1]]", "/springs/0/nodes/0: got [0,1,1,1,1], expected a row [from, to]", true},
           {"/springs/0/nodes", "[[0, 1.5]]", "/springs/0/nodes/0: got [0,1.5], expected two whole numbers >= 0 first", false},
           {"/springs/0/nodes", "[[-1, 1]]", "/springs/0/nodes/0: got [-1,1], expected two whole numbers >= 0 first", true},
           {"/springs/0/nodes", "[[3, 3]]", "/springs/0/nodes/0: got [3,3], expected two different nodes", false},
           {"/springs/0/nodes", "[[0, 1, 0]]", "/springs/0/nodes/0/2: got 0, expected a number > 0", false},
           {"/springs/0/nodes", "[[0, 1, 1, -2]]", "/springs/0/nodes/0/3: got -2, expected a number > 0", true},
           {"/springs/0/spring", "{}", "/springs/0/spring: got {}, expected a number \"stiffness\" > 0 [N/m]: only", false},
           {"/springs/0/file", "\"a.csv\"", "/springs/0: got both \"nodes\" and \"file\", expected exactly one", true},
           {"/springs/0/rods", "1", "/bodies/0/springs/0: got the unknown key \"rods\"", true}}) {
    Json scene = skin();
    scene[Json::json_pointer(std::string("/bodies/0") + m.pointer)] = Json::parse(m.value);
    const std::string got = model_test::message(scene.dump());
    EXPECT_NE(got.find(m.expected), std::string::npos) << got;
    EXPECT_EQ(schema().findings(scene).empty(), !m.in_schema) << m.pointer << ' ' << m.value;
  }
}

TEST(SceneSpringLists, BodiesAndScenesThatCannotHaveThemAreTold) {
  Json lattice = skin();
  lattice["bodies"][0].erase("thickness");
  lattice["bodies"][0]["lattice"] = {{"spacing", 0.01}};
  EXPECT_NE(model_test::message(lattice.dump()).find("expected no springs between nodes of a lattice"), std::string::npos)
      << model_test::message(lattice.dump());
  Json at_rest = skin();
  at_rest["solver"] = {{"type", "static"}};
  EXPECT_NE(model_test::message(at_rest.dump()).find("/bodies/0/springs: "), std::string::npos)
      << model_test::message(at_rest.dump());
  Json damped = skin();
  damped["bodies"][0]["springs"][0]["spring"]["damping"] = 0.1;
  damped["integrator"] = "textbook";
  EXPECT_NE(model_test::message(damped.dump()).find("/bodies/0/springs/0/spring has a damping"), std::string::npos)
      << model_test::message(damped.dump());
  Json alone = skin();
  alone["bodies"][0]["model"] = {{"type", "mass-spring"}, {"edge_springs", false}};
  EXPECT_EQ(model_test::message(alone.dump()), "");
  EXPECT_TRUE(schema().findings(alone).empty());
  alone["bodies"][0].erase("springs");
  EXPECT_NE(
      model_test::message(alone.dump()).find("/model/edge_springs: got false, expected true in a body without \"springs\""),
      std::string::npos)
      << model_test::message(alone.dump());
}

TEST(SceneSpringLists, AreWrittenAndReadAgain) {
  const Scene scene = parse_scene(skin().dump(), "s.json"), again = parse_scene(scene_to_json(scene), "s.json");
  ASSERT_EQ(again.bodies[0].springs.size(), 1U);
  const SpringList& list = again.bodies[0].springs[0];
  EXPECT_EQ(list.nodes, (std::vector<std::array<std::int32_t, 2>>{{0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ(list.factor, (std::vector<double>{1, 2.5, 1}));
  EXPECT_EQ(list.length, (std::vector<double>{0, 0, 0.03}));
  EXPECT_EQ(list.spring.stiffness, 4);
}

class SpringFile : public ::testing::Test {
 protected:
  std::string read(const std::string& text) {
    std::ofstream(folder_.path() / "s.csv") << text;
    Json scene = skin();
    scene["bodies"][0]["springs"][0].erase("nodes");
    scene["bodies"][0]["springs"][0]["file"] = "s.csv";
    EXPECT_TRUE(schema().findings(scene).empty());
    return test::error_of([&] { scene_ = parse_scene(scene.dump(), (folder_.path() / "s.json").string()); });
  }
  test::TempFolder folder_;
  Scene scene_;
};

TEST_F(SpringFile, IsReadAndEachMistakeNamesItsLine) {
  EXPECT_EQ(read("from,to,factor\n0,1,2\n2, 3, 0.5\r\n"), "");
  EXPECT_EQ(scene_.bodies[0].springs[0].nodes, (std::vector<std::array<std::int32_t, 2>>{{0, 1}, {2, 3}}));
  EXPECT_EQ(scene_.bodies[0].springs[0].factor, (std::vector<double>{2, 0.5}));
  EXPECT_EQ(scene_.bodies[0].springs[0].place(1), "/bodies/0/springs/0: " + (folder_.path() / "s.csv").string() + ":3");
  for (const auto& [text, expected] : std::vector<std::pair<const char*, const char*>>{
           {"a,b\n0,1\n", "s.csv:1: got \"a,b\", expected the first line \"from,to\""},
           {"from,to\n0,1\n0;2\n", "s.csv:3: got \"0;2\", expected 2 numbers separated by commas"},
           {"from,to,factor\n0,1\n", "s.csv:2: got \"0,1\", expected 3 numbers separated by commas"},
           {"from,to\n1,1\n", "s.csv:2: got \"1,1\", expected two different nodes"},
           {"from,to,factor,length\n0,1,1,-1\n", "s.csv:2: got \"0,1,1,-1\", expected a length > 0"},
           {"from,to,factor\n0,1,nan\n", "s.csv:2: got \"0,1,nan\", expected a factor > 0"},
           {"from,to\n", "/springs/0/file: got \"s.csv\", expected a CSV file with at least one spring"},
           {"", "/springs/0/file: got \"s.csv\", expected a CSV file that can be read"}}) {
    const std::string got = read(text);
    EXPECT_NE(got.find(expected), std::string::npos) << got;
  }
}

TEST(SpecSpringLists, AreThoseOfTheFileAndNumbersFitTheSprings) {
  SceneSpec spec;
  spec.name = "scene";
  BodySpec& b = spec.bodies.emplace_back();
  b.name = "a";
  b.surface_file = "a.obj";
  b.thickness = 0.002;
  b.material.young = 3000;
  b.material.poisson = 0.25;
  SpringListSpec& list = b.springs.emplace_back();
  list.nodes = {{0, 1}, {1, 2}, {2, 0}};
  list.factor = {1, 2.5, 1};
  list.length = {0, 0, 0.03};
  list.spring.stiffness = 4;
  Json same = skin();
  same["name"] = "scene";
  EXPECT_EQ(scene_to_json(scene_of(spec)), scene_to_json(parse_scene(same.dump(), "")));
  list.length = {0.1};
  EXPECT_NE(test::error_of([&] {
              (void)scene_of(spec);
            }).find("body \"a\": springs 0: got 1 numbers \"length\", expected none or one for each of the 3 springs"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant::spring_lists_scene_test
