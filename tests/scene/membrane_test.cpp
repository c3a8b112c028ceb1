// The membrane of a body in scene files and in the API: each mistake gets one message, and what is written is read again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/patched_scene.h"

namespace pliant::membrane_scene_test {
namespace {

using Json = nlohmann::json;
using model_test::schema;

Json good() {
  return Json::parse(R"({"format": "pliant-scene/1", "bodies": [
    {"name": "a", "surface": "a.obj", "lattice": {"spacing": 0.01}, "material": {"young": 3000, "poisson": 0.45},
     "membrane": {"thickness": 0.0001, "young": 8e6}}]})");
}

TEST(SceneMembrane, EachMistakeHasOneMessage) {
  const std::vector<std::array<const char*, 3>> mistakes{
      {"", "{}", "/bodies/0/membrane: got no \"thickness\", expected"},
      {"/thickness", "0", "/bodies/0/membrane/thickness: got 0, expected a number > 0"},
      {"/young", "-1", "/bodies/0/membrane/young: got -1, expected a number > 0"},
      {"/poisson", "0.6", "/bodies/0/membrane/poisson: got 0.6, expected a number with 0 <= poisson <= 0.5"},
      {"/density", "-1", "/bodies/0/membrane/density: got -1, expected a number >= 0"},
      {"/bending", "1", "/bodies/0/membrane: got the unknown key \"bending\""},
  };
  ASSERT_EQ(model_test::message(good().dump()), "");
  EXPECT_TRUE(schema().findings(good()).empty());
  for (const auto& [pointer, value, expected] : mistakes) {
    Json scene = good();
    scene[Json::json_pointer(std::string("/bodies/0/membrane") + pointer)] = Json::parse(value);
    const std::string got = model_test::message(scene.dump());
    EXPECT_NE(got.find(expected), std::string::npos) << got;
    EXPECT_FALSE(schema().findings(scene).empty()) << pointer;
  }
}

TEST(SceneMembrane, StaticSolutionsRefuseIt) {
  Json scene = good();
  scene["solver"] = {{"type", "static"}};
  EXPECT_NE(
      model_test::message(scene.dump()).find("/bodies/0/membrane: got an object with 2 keys, expected none with \"solver\""),
      std::string::npos)
      << model_test::message(scene.dump());
}

TEST(SceneMembrane, IsWrittenAndReadAgain) {
  const Scene scene = parse_scene(good().dump(), "s.json");
  ASSERT_TRUE(scene.bodies[0].membrane.has_value());
  EXPECT_EQ(scene.bodies[0].membrane->poisson, 0.5);
  const Scene again = parse_scene(scene_to_json(scene), "s.json");
  EXPECT_EQ(again.bodies[0].membrane, scene.bodies[0].membrane);
}

}  // namespace
}  // namespace pliant::membrane_scene_test
