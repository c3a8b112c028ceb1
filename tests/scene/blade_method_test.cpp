// The key "method" of blades: what is read, and the messages about what is not allowed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scene.h"
#include "support/error_of.h"

namespace pliant::blade_method_test {
namespace {

nlohmann::json separating() {
  return nlohmann::json::parse(R"({"format": "pliant-scene/1", "bodies": [{"name": "b", "mesh": "m.msh", "element": "tet4",
    "material": {"young": 1000, "poisson": 0.4, "density": 1000}}],
    "blades": [{"method": "separation", "path": [[0, 0, 0, 0, 1, 0, 0], [1, 0, 1, 0, 1, 1, 0]]},
               {"method": "separation", "path": [[0, 0, 0, 1, 1, 0, 1], [1, 0, 1, 1, 1, 1, 1]]}]})");
}

std::string message(const nlohmann::json& scene) {
  return test::error_of([&] { static_cast<void>(parse_scene(scene.dump(), "dir/s.json")); });
}

void expect_message(const nlohmann::json& scene, const std::string& place, const std::string& allowed) {
  EXPECT_NE(message(scene).find(place), std::string::npos) << message(scene);
  EXPECT_NE(message(scene).find(allowed), std::string::npos) << message(scene);
}

TEST(BladeMethod, IsReadAndWritten) {
  const Scene scene = parse_scene(separating().dump(), "dir/s.json");
  EXPECT_EQ(scene.blades[1].method, BladeMethod::separation);
  EXPECT_TRUE(parts_along_faces(scene));
  EXPECT_EQ(parse_scene(scene_to_json(scene), "dir/s.json").blades[1].method, BladeMethod::separation);
  nlohmann::json usual = separating();
  for (auto& blade : usual["blades"]) blade.erase("method");
  EXPECT_EQ(parse_scene(usual.dump(), "dir/s.json").blades[0].method, BladeMethod::virtual_nodes);
  EXPECT_FALSE(parts_along_faces(parse_scene(usual.dump(), "dir/s.json")));
}

TEST(BladeMethod, GoesWithEveryOtherKeyOfABladeAndWithTearing) {
  nlohmann::json scene = separating();
  scene["bodies"][0]["material"]["toughness"] = 500;
  EXPECT_EQ(message(scene), "");
  scene["blades"][0]["cuts"] = "by-force";
  scene["blades"][0]["edge"] = 0.001;
  EXPECT_EQ(message(scene), "");
}

TEST(BladeMethod, DivisionAndRemovalSayWhatTheyNeed) {
  for (const char* method : {"decomposition", "removal"}) {
    nlohmann::json scene = separating();
    for (auto& blade : scene["blades"]) blade["method"] = method;
    EXPECT_EQ(message(scene), "");
    const Scene read = parse_scene(scene.dump(), "dir/s.json");
    EXPECT_TRUE(remakes_elements(read));
    EXPECT_TRUE(read.bodies[0].plain);
    EXPECT_EQ(parse_scene(scene_to_json(read), "dir/s.json").blades[0].method, blade_method(read));
    const bool removes = method == std::string("removal");
    scene["bodies"][0]["element"] = "hex8";
    if (removes) {
      EXPECT_EQ(message(scene), "");
    } else {
      expect_message(scene, "/bodies/0/element: got \"hex8\"", "tet4 or tet4anp, because blades with the method");
    }
    scene["bodies"][0].erase("element");
    scene["bodies"][0]["material"]["toughness"] = 500;
    expect_message(scene, "/blades", "because a material has a toughness");
    scene["blades"][1]["cuts"] = "by-force";
    scene["blades"][1]["edge"] = 0.001;
    if (removes) {
      expect_message(scene, "/blades/1/cuts", "because the blade removes what it touches");
    } else {
      EXPECT_EQ(message(scene), "");
    }
  }
}

TEST(BladeMethod, ANetworkOfSpringsIsNotDivided) {
  nlohmann::json scene = separating();
  scene["bodies"][0]["model"] = {{"type", "mass-spring"}};
  for (auto& blade : scene["blades"]) blade["method"] = "removal";
  EXPECT_EQ(message(scene), "");
  for (auto& blade : scene["blades"]) blade["method"] = "decomposition";
  expect_message(scene, "/bodies/0/model/type", "is another network");
}

TEST(BladeMethod, SaysWhatIsWrong) {
  nlohmann::json scene = separating();
  scene["blades"][1]["method"] = "removal";
  expect_message(scene, "/blades/1/method: got \"removal\"", "all blades of a scene have the same");
  scene["blades"][1]["method"] = "magic";
  expect_message(scene, "/blades/1/method: got \"magic\"", "one of virtual-nodes, separation, decomposition, removal");
  scene["blades"][1]["method"] = "virtual-nodes";
  expect_message(scene, "/blades/1/method", "all blades of a scene have the same");
  scene["blades"][1].erase("method");
  expect_message(scene, "/blades/1", "all blades of a scene have the same");
  scene = separating();
  scene["bodies"][0] = nlohmann::json::parse(R"({"name": "b", "surface": "s.obj", "lattice": {"spacing": 0.01},
    "material": {"young": 1000, "poisson": 0.4, "density": 1000}})");
  EXPECT_EQ(message(scene), "");
  for (const char* model : {"flsm", "hybrid"}) {
    scene["bodies"][0]["model"] = {{"type", model}};
    if (scene["bodies"][0]["model"]["type"] == "hybrid") scene["bodies"][0]["model"]["ratio"] = 0.5;
    expect_message(scene, "/blades/0/method", "shape matching moves nodes of body 'b'");
  }
  scene = separating();
  scene["bodies"][0]["element"] = "hex8";
  EXPECT_EQ(message(scene), "");
  scene = separating();
  for (auto& blade : scene["blades"]) blade.erase("method");
  scene["bodies"][0]["material"]["toughness"] = 500;
  expect_message(scene, "/blades", "with the method \"separation\", because a material has a toughness");
}

}  // namespace
}  // namespace pliant::blade_method_test
