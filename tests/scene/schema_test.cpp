// scenes/schema.json, the loader and the shipped scenes must agree.
#include <gtest/gtest.h>

#include <fstream>

#include "scene/keys.h"
#include "scene/scene.h"
#include "scene/schema_check.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path scenes = fs::path(test::source_dir()) / "scenes";

Json json_of(const fs::path& file) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  return Json::parse(stream);
}

std::vector<fs::path> shipped() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(scenes)) {
    if (entry.path().extension() == ".json" && entry.path().filename() != "schema.json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST(Schema, HasTheKeysOfTheLoader) {
  const Json schema = json_of(scenes / "schema.json");
  for (const auto& [kind, keys] : scene_keys()) {
    const Json& definition = kind == "scene" ? schema : schema.at("$defs").at(kind);
    EXPECT_EQ(keys_of(definition.at("properties")), std::set<std::string>(keys.begin(), keys.end())) << kind;
    EXPECT_EQ(definition.at("additionalProperties"), false) << kind;
  }
}

TEST(Schema, HasTheWordsOfTheLoader) {
  const Json schema = json_of(scenes / "schema.json");
  EXPECT_EQ(schema["$defs"]["probe"]["properties"]["quantities"]["items"]["enum"], Json(words_only(quantity_words())));
}

TEST(Schema, ShippedScenesFollowItAndLoad) {
  const SchemaCheck check(json_of(scenes / "schema.json"));
  ASSERT_GE(shipped().size(), 10U);
  for (const fs::path& file : shipped()) {
    for (const std::string& finding : check.findings(json_of(file))) ADD_FAILURE() << file.filename() << finding;
    EXPECT_NO_THROW({
      const Scene scene = load_scene(file);
      for (const std::string& finding : check.findings(Json::parse(scene_to_json(scene)))) {
        ADD_FAILURE() << "rewritten " << file.filename() << finding;
      }
    });
  }
}

TEST(Schema, RefusesWhatTheLoaderRefuses) {
  const SchemaCheck check(json_of(scenes / "schema.json"));
  const Json good = Json::parse(R"({"format": "pliant-scene/1", "bodies": [{"surface": "a.obj", "lattice": {"spacing": 0.1},
      "material": {"young": 3000, "poisson": 0.45}, "fixed": [{"all": true}],
      "forces": [{"box": [[0, 0, 0], [1, 1, 1]], "force": [0, 0, 1], "curve": "ramp", "duration": 1}]}]})");
  ASSERT_TRUE(check.findings(good).empty()) << check.findings(good).front();
  const std::vector<std::pair<const char*, const char*>> patches{{"/bodies/0/material/poisson", "0.5"},
                                                                 {"/bodies/0/material/mu", "1"},
                                                                 {"/bodies/0/lattice/nodes", "100"},
                                                                 {"/bodies/0/mesh", "\"a.msh\""},
                                                                 {"/bodies/0/elment", "\"hex8\""},
                                                                 {"/bodies/0/element", "\"hex9\""},
                                                                 {"/bodies/0/fixed/0/axes", "\"xx\""},
                                                                 {"/bodies/0/fixed/0/nodes", "[1]"},
                                                                 {"/bodies/0/forces/0/curve", "\"sine\""},
                                                                 {"/safety", "1.5"},
                                                                 {"/bodies", "[]"}};
  for (const auto& [pointer, value] : patches) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = Json::parse(value);
    EXPECT_FALSE(check.findings(bad).empty()) << pointer << " = " << value;
    EXPECT_ANY_THROW(parse_scene(bad.dump(), "s.json")) << pointer << " = " << value;
  }
}

}  // namespace
}  // namespace pliant
