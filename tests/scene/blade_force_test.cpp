// Keys of blades that cut by force: what is read, and the messages about what is not allowed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pliant/error.h"
#include "scene/blade_face.h"
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

nlohmann::json with_faces() {
  nlohmann::json scene = by_force();
  scene["blades"][0]["thickness"] = 0.002;
  scene["blades"][0]["height"] = 0.01;
  return scene;
}

TEST(BladeFaceKeys, AreReadAndWrittenWithTheBlade) {
  nlohmann::json scene = with_faces();
  scene["tools"] = nlohmann::json::parse(R"([{"name": "probe", "shape": {"sphere": 0.01}}])");
  const Scene read = parse_scene(scene.dump(), "dir/s.json");
  EXPECT_EQ(read.blades[0].thickness, 0.002);
  EXPECT_EQ(read.blades[0].height, 0.01);
  ASSERT_EQ(read.tools.size(), 3U);
  EXPECT_TRUE(!is_face(read.tools[0]) && is_face(read.tools[1]) && is_face(read.tools[2]));
  EXPECT_EQ(read.tools[1].side, -read.tools[2].side);
  EXPECT_EQ(read.tools[1].friction, 0.1);
  const nlohmann::json written = nlohmann::json::parse(scene_to_json(read));
  EXPECT_EQ(written["tools"].size(), 1U);
  EXPECT_EQ(written["blades"][0]["height"], 0.01);
  EXPECT_FALSE(written["blades"][0].contains("back"));
  EXPECT_EQ(parse_scene(scene_to_json(read), "dir/s.json").tools.size(), 3U);
}

/// The edge leads along x and moves along y; the back is behind it, whatever the path does later, and turns with the edge.
TEST(BladeFaceKeys, TheBackIsBehindTheFirstMotion) {
  nlohmann::json scene = with_faces();
  scene["blades"][0]["path"] = nlohmann::json::parse(
      "[[0, 0, 0, 0, 1, 0, 0], [1, 0.5, 0, 0, 1.5, 0, 0], [2, 0.5, -1, 0, 1.5, -1, 0], [3, 0, 5, 0, 0, 5, 1]]");
  const Blade blade = parse_scene(scene.dump(), "dir/s.json").blades[0];
  EXPECT_EQ(blade.back_at_first(), (Vec3d{0, 1, 0}));
  const Pose first = blade_frame(blade, blade.at(0));
  EXPECT_NEAR(first.position[1], 0.005, 1e-15);
  const std::array<Vec3d, 3> r = rotation_matrix(first.turn);  // its columns are x, y, z
  EXPECT_NEAR(r[1][1], 1, 1e-12);
  EXPECT_NEAR(r[0][2], 1, 1e-12);
  EXPECT_NEAR(r[2][0], -1, 1e-12);
  const std::array<Vec3d, 3> last = rotation_matrix(blade_frame(blade, blade.at(3)).turn);
  EXPECT_NEAR(last[1][1], 1, 1e-12);
  EXPECT_NEAR(last[2][2], 1, 1e-12);
  scene["blades"][0]["back"] = {3, 0, -2};
  EXPECT_EQ(parse_scene(scene.dump(), "dir/s.json").blades[0].back_at_first(), (Vec3d{0, 0, -1}));
}

TEST(BladeFaceKeys, SayWhatIsWrong) {
  nlohmann::json scene = with_faces();
  scene["blades"][0]["thickness"] = -0.001;
  expect_message(scene, "/blades/0/thickness: got -0.001", "> 0");
  scene = with_faces();
  scene["blades"][0]["height"] = 0.0015;
  expect_message(scene, "/blades/0/height: got 0.0015", "at least the thickness, 0.002 m");
  scene["blades"][0].erase("height");
  expect_message(scene, "/blades/0", "at least the thickness, 0.002 m");
  scene = with_faces();
  scene["blades"][0].erase("thickness");
  expect_message(scene, "/blades/0/height", "no height of a blade without a \"thickness\"");
  scene = with_faces();
  for (const char* key : {"edge", "sharpness", "friction", "height"}) scene["blades"][0].erase(key);
  scene["blades"][0]["cuts"] = "always";
  expect_message(scene, "/blades/0/thickness", "no thickness of a blade that does not cut \"by-force\"");
  scene = with_faces();
  scene["blades"][0]["path"] = nlohmann::json::parse("[[0, 0, 0, 0, 1, 0, 0], [1, 2, 0, 0, 3, 0, 0]]");
  expect_message(scene, "/blades/0", "a direction [x, y, z] from the edge to the back of the blade");
  scene["blades"][0]["back"] = {-1, 0, 0};
  expect_message(scene, "/blades/0/back", "a direction [x, y, z] from the edge to the back of the blade");
  scene["blades"][0]["back"] = {0, 0, 1};
  EXPECT_EQ(message(scene), "");
  scene["tools"] = nlohmann::json::parse(R"J([{"name": "blade0 (face 1)", "shape": {"sphere": 0.01}}])J");
  expect_message(scene, "/blades/0/thickness", "no tool \"blade0 (face 1)\"");
}

}  // namespace
}  // namespace pliant::blade_force_test
