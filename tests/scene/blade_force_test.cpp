// Keys of blades that cut by force: what is read, and the messages about what is not allowed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pliant/error.h"
#include "scene/scene.h"

namespace pliant::blade_force_test {
namespace {

nlohmann::json by_force() {
  return nlohmann::json::parse(R"({"format": "pliant-scene/1", "bodies": [{"name": "b", "surface": "s.obj",
    "lattice": {"spacing": 0.01}, "material": {"young": 1000, "poisson": 0.4, "density": 1000, "toughness": 500}}],
    "blades": [{"cuts": "by-force", "edge": 0.001, "sharpness": 0.5, "friction": 0.1,
                "path": [[0, 0, 0, 0, 1, 0, 0], [1, 0, 1, 0, 1, 1, 0]]}]})");
}

std::string message(const nlohmann::json& scene) {
  try {
    static_cast<void>(parse_scene(scene.dump(), "dir/s.json"));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

void expect_message(const nlohmann::json& scene, const std::string& place, const std::string& allowed) {
  EXPECT_NE(message(scene).find(place), std::string::npos) << message(scene);
  EXPECT_NE(message(scene).find(allowed), std::string::npos) << message(scene);
}

TEST(BladeByForce, IsReadAndWritten) {
  const Scene scene = parse_scene(by_force().dump(), "dir/s.json");
  ASSERT_EQ(scene.blades.size(), 1U);
  EXPECT_EQ(scene.blades[0].cuts, BladeCuts::by_force);
  EXPECT_EQ(scene.blades[0].sharpness, 0.5);
  EXPECT_EQ(scene.blades[0].edge, 0.001);
  EXPECT_EQ(scene.blades[0].friction, 0.1);
  EXPECT_TRUE(cuts_by_force(scene));
  const Scene again = parse_scene(scene_to_json(scene), "dir/s.json");
  EXPECT_EQ(again.blades[0].cuts, BladeCuts::by_force);
  EXPECT_EQ(again.blades[0].edge, 0.001);
}

TEST(BladeByForce, SaysWhatIsWrong) {
  nlohmann::json scene = by_force();
  scene["blades"][0]["sharpness"] = -1;
  expect_message(scene, "/blades/0/sharpness: got -1", "> 0");
  scene = by_force();
  scene["blades"][0].erase("edge");
  expect_message(scene, "/blades/0", "the radius of the edge in metres, because the blade cuts by force");
  scene = by_force();
  scene["blades"][0]["cuts"] = "always";
  expect_message(scene, "/blades/0/sharpness", "no sharpness of a blade that does not cut \"by-force\"");
  scene = by_force();
  scene["bodies"][0]["material"].erase("toughness");
  expect_message(scene, "/blades/0/cuts", "a material with a \"toughness\" [Pa] in at least one body");
  scene = by_force();
  for (const char* key : {"cuts", "edge", "sharpness", "friction"}) scene["blades"][0].erase(key);
  scene["bodies"][0]["material"].erase("toughness");
  EXPECT_EQ(message(scene), "");
}

}  // namespace
}  // namespace pliant::blade_force_test
