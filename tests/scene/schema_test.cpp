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
  const std::map<std::string, std::vector<std::string>> pointers{
      {"law", {"/$defs/material/properties/law"}},
      {"element", {"/$defs/body/properties/element"}},
      {"integrator", {"/properties/integrator"}},
      {"inverted", {"/properties/inverted"}},
      {"curve",
       {"/$defs/gravity/properties/curve", "/$defs/prescribed/properties/curve", "/$defs/force/properties/curve",
        "/$defs/pressure/properties/curve"}},
      {"model", {"/$defs/model/properties/type"}},
      {"goals", {"/$defs/model/properties/goals"}},
      {"coupling", {"/$defs/model/properties/coupling"}},
      {"follow", {"/$defs/model/properties/follow"}},
      {"solver", {"/$defs/solver/properties/type"}},
      {"quantity", {"/$defs/probe/properties/quantities/items"}}};
  ASSERT_EQ(pointers.size(), scene_words().size());
  for (const auto& [kind, list] : pointers) {
    for (const std::string& pointer : list) {
      EXPECT_EQ(schema.at(Json::json_pointer(pointer)).at("enum"), Json(scene_words().at(kind))) << pointer;
    }
  }
}

TEST(Schema, DefaultsAreThoseOfTheStructs) {
  const Json schema = json_of(scenes / "schema.json");
  const auto number = [&](const char* pointer) { return schema.at(Json::json_pointer(pointer)).at("default").get<double>(); };
  EXPECT_EQ(number("/properties/safety"), Scene().safety);
  EXPECT_EQ(number("/properties/least_fill"), Scene().least_fill);
  EXPECT_EQ(number("/properties/least_step"), Scene().least_step);
  EXPECT_EQ(number("/properties/break_stretch"), Scene().break_stretch);
  EXPECT_EQ(number("/properties/duration"), Scene().duration);
  EXPECT_EQ(number("/$defs/relaxation/properties/tolerance"), Relaxation().tolerance);
  EXPECT_EQ(number("/$defs/relaxation/properties/max_steps"), static_cast<double>(Relaxation().max_steps));
  EXPECT_EQ(number("/$defs/material/properties/density"), Material().density);
  EXPECT_EQ(number("/$defs/material/properties/damping"), Material().damping);
  EXPECT_EQ(number("/$defs/material/properties/hourglass"), Material().hourglass);
  EXPECT_EQ(number("/$defs/body/properties/scale"), Body().scale);
  const std::string model = "/$defs/model/properties/";
  EXPECT_EQ(number((model + "ratio").c_str()), DeformationModel().ratio);
  EXPECT_EQ(number((model + "width").c_str()), DeformationModel().width);
  EXPECT_EQ(number((model + "damping").c_str()), DeformationModel().damping);
  EXPECT_EQ(number((model + "substeps").c_str()), DeformationModel().substeps);
  const auto word = [&](const char* key) {
    return schema.at(Json::json_pointer(model + key)).at("default").get<std::string>();
  };
  EXPECT_EQ(word("beta"), "auto");
  EXPECT_EQ(word("goals"), word_of(goals_words(), DeformationModel().extrapolate));
  EXPECT_EQ(word("coupling"), word_of(coupling_words(), DeformationModel().conservative));
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
