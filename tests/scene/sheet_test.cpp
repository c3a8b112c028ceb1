// Sheets and vessels in scene files: each mistake gets one message, and what is written is read again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pliant/scene.h"
#include "scene/patched_scene.h"

namespace pliant::sheet_scene_test {
namespace {

using Json = nlohmann::json;
using model_test::schema;

Json sheet() {
  return Json::parse(R"({"format": "pliant-scene/1", "bodies": [
    {"name": "a", "surface": "a.obj", "thickness": 0.002, "model": {"type": "mass-spring"},
     "material": {"young": 3000, "poisson": 0.25, "toughness": 900}}]})");
}

Json organ() {
  return Json::parse(R"({"format": "pliant-scene/1", "bodies": [
    {"name": "a", "surface": "a.obj", "lattice": {"spacing": 0.01}, "material": {"young": 3000, "poisson": 0.45},
     "vessels": [{"points": [[0, 0, 0], [0, 0.02, 0], [0.01, 0.03, 0]], "segments": [[0, 1], [1, 2]], "radius": 0.002,
                  "young": 6e5}]}]})");
}

void expect_mistakes(const Json& good, const std::vector<std::array<const char*, 3>>& mistakes) {
  ASSERT_EQ(model_test::message(good.dump()), "");
  EXPECT_TRUE(schema().findings(good).empty());
  for (const auto& [pointer, value, expected] : mistakes) {
    Json scene = good;
    scene[Json::json_pointer(std::string("/bodies/0") + pointer)] = Json::parse(value);
    const std::string got = model_test::message(scene.dump());
    EXPECT_NE(got.find(expected), std::string::npos) << got;
    EXPECT_FALSE(schema().findings(scene).empty()) << pointer;
  }
}

TEST(SceneSheet, EachMistakeHasOneMessage) {
  expect_mistakes(sheet(), {{"/thickness", "0", "/bodies/0/thickness: got 0, expected a number > 0"},
                            {"/lattice", R"({"spacing": 0.01})", "expected no lattice with a \"thickness\""},
                            {"/element", "\"hex8\"", "expected tet4 or tet4anp: a sheet is a layer of tetrahedra"},
                            {"/model", R"({"type": "flsm"})", "expected tled or mass-spring with a volume mesh or a sheet"}});
  Json mesh = sheet();
  mesh["bodies"][0].erase("surface");
  mesh["bodies"][0]["mesh"] = "a.msh";
  EXPECT_NE(model_test::message(mesh.dump()).find("/bodies/0/thickness: got 0.002, expected no thickness with a volume mesh"),
            std::string::npos)
      << model_test::message(mesh.dump());
  EXPECT_FALSE(schema().findings(mesh).empty());
}

TEST(SceneSheet, IsWrittenAndReadAgain) {
  const Scene scene = parse_scene(sheet().dump(), "s.json"), again = parse_scene(scene_to_json(scene), "s.json");
  EXPECT_EQ(again.bodies[0].thickness, 0.002);
  EXPECT_EQ(again.bodies[0].element, ElementKind::tet4);
  EXPECT_FALSE(again.bodies[0].has_lattice());
}

TEST(SceneVessels, EachMistakeHasOneMessage) {
  expect_mistakes(organ(),
                  {{"/vessels/0/points", "[[0, 0, 0]]",
                    "/bodies/0/vessels/0/points: got [[0,0,0]], expected a list of at least two places"},
                   {"/vessels/0/radius", "0", "/bodies/0/vessels/0/radius: got 0, expected a number > 0"},
                   {"/vessels/0/young", "-1", "/bodies/0/vessels/0/young: got -1, expected a number > 0"},
                   {"/vessels/0/density", "-1", "/bodies/0/vessels/0/density: got -1, expected a number >= 0"},
                   {"/vessels/0/segments", "[[0]]", "/bodies/0/vessels/0/segments/0: got [0], expected two different numbers"},
                   {"/vessels/0/lumen", "1", "/bodies/0/vessels/0: got the unknown key \"lumen\""}});
}

TEST(SceneVessels, SegmentsAndWallsThatCannotBeAreRefused) {
  const std::vector<std::array<const char*, 3>> mistakes{
      {"/segments", "[[0, 3]]", "/vessels/0/segments/0/1: got 3, expected a whole number from 0 to 2"},
      {"/segments", "[[1, 1]]", "/vessels/0/segments/0: got [1,1], expected two different numbers of points, from 0 to 2"},
      {"/points", "[[0, 0, 0], [0, 0, 0], [1, 0, 0]]",
       "expected points 0 and 1, which a segment connects, at different places"},
      {"/wall", "0.002", "/vessels/0/wall: got 0.002, expected a wall thinner than the radius, 0.002 m"}};
  for (const auto& [pointer, value, expected] : mistakes) {
    Json scene = organ();
    scene[Json::json_pointer(std::string("/bodies/0/vessels/0") + pointer)] = Json::parse(value);
    const std::string got = model_test::message(scene.dump());
    EXPECT_NE(got.find(expected), std::string::npos) << got;
  }
  Json at_rest = organ();
  at_rest["solver"] = {{"type", "static"}};
  EXPECT_NE(
      model_test::message(at_rest.dump()).find("expected none with \"solver\": {\"type\": \"static\"}, which knows no vessels"),
      std::string::npos)
      << model_test::message(at_rest.dump());
}

TEST(SceneVessels, AreWrittenAndReadAgain) {
  Json tube = organ();
  tube["bodies"][0]["vessels"][0].erase("segments");
  tube["bodies"][0]["vessels"][0]["wall"] = 0.0004;
  const Scene scene = parse_scene(tube.dump(), "s.json"), again = parse_scene(scene_to_json(scene), "s.json");
  ASSERT_EQ(again.bodies[0].vessels.size(), 1U);
  const Vessel &was = scene.bodies[0].vessels[0], &is = again.bodies[0].vessels[0];
  EXPECT_EQ(is.points, was.points);
  EXPECT_EQ(is.segments, (std::vector<std::array<std::int32_t, 2>>{{0, 1}, {1, 2}}));
  EXPECT_EQ(is.area(), was.area());
  EXPECT_NEAR(is.area(), std::numbers::pi * (0.002 * 0.002 - 0.0016 * 0.0016), 1e-18);
}

}  // namespace
}  // namespace pliant::sheet_scene_test
