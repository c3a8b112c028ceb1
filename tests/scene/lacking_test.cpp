// What this version lacks is said by name, and what is said is true: nothing in the table is there after all, and what is
// named as nearest exists.
#include "mesh_io/lacking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "mesh_io/mesh_io.h"
#include "scene/keys.h"
#include "scene/scene.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using Json = nlohmann::json;

std::string plain(std::string word) {
  std::erase_if(word, [](char c) { return c == '-' || c == '_'; });
  return word;
}

std::vector<std::string> words_of(const Lacking& entry) {
  std::istringstream text{std::string(entry.words)};
  return {std::istream_iterator<std::string>(text), {}};
}

std::vector<std::string> allowed_at(const std::string& where) {
  static const std::map<std::string, std::vector<std::string>> words{{"law", words_only(law_words())},
                                                                     {"element", words_only(element_words())},
                                                                     {"integrator", words_only(integrator_words())},
                                                                     {"model/type", words_only(model_words())},
                                                                     {"solver/type", {"dynamic", "static"}},
                                                                     {"curve", words_only(curve_words())},
                                                                     {"surface", {"obj", "stl", "ply", "3ds", "gltf", "glb"}},
                                                                     {"mesh", {"msh", "vtk", "vtu", "node", "ele"}}};
  if (where.starts_with("key of ")) return scene_keys().at(where.substr(7));
  return words.at(where);
}

TEST(Lacking, NothingIsThereAfterAll) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const Lacking& entry : lacking_table()) {
    const std::string where(entry.where);
    std::vector<std::string> allowed = allowed_at(where);
    for (std::string& word : allowed) word = plain(word);
    for (const std::string& word : words_of(entry)) {
      EXPECT_EQ(std::count(allowed.begin(), allowed.end(), word), 0) << where << ": " << word;
      EXPECT_TRUE(seen.emplace(where, word).second) << where << ": " << word << " twice";
      EXPECT_EQ(plain(word), word);
    }
  }
}

TEST(Lacking, WhatIsNearestExists) {
  std::set<std::string> known;
  for (const char* where : {"law", "element", "integrator", "model/type", "solver/type", "curve"}) {
    for (const std::string& word : allowed_at(where)) known.insert(word);
  }
  for (const auto& [kind, keys] : scene_keys()) known.insert(keys.begin(), keys.end());
  const std::regex quoted("\"([^\"]+)\"");
  for (const Lacking& entry : lacking_table()) {
    const std::string text(entry.nearest);
    for (auto at = std::sregex_iterator(text.begin(), text.end(), quoted); at != std::sregex_iterator(); ++at) {
      EXPECT_TRUE(known.contains((*at)[1])) << entry.where << ": " << (*at)[1];
    }
  }
}

/// The message for a scene with this member replaced or added.
std::string message_with(const std::string& pointer, const Json& value) {
  Json scene = Json::parse(R"({"format": "pliant-scene/1", "integrator": "increment", "solver": {"type": "dynamic"},
    "tools": [{"shape": {"sphere": 0.1}}], "bodies": [{"surface": "a.obj", "lattice": {"spacing": 0.1},
    "model": {"type": "tled"}, "material": {"young": 3000, "poisson": 0.45},
    "prescribed": [{"all": true, "displacement": [0, 0, 0], "curve": "smooth", "duration": 1}]}]})");
  scene[Json::json_pointer(pointer)] = value;
  return test::error_of([&] { parse_scene(scene.dump(), "dir/s.json"); });
}

TEST(Lacking, EveryWordOfASceneIsAnswered) {
  const std::map<std::string, std::string> place{
      {"law", "/bodies/0/material/law"},          {"element", "/bodies/0/element"}, {"integrator", "/integrator"},
      {"model/type", "/bodies/0/model/type"},     {"solver/type", "/solver/type"},  {"curve", "/bodies/0/prescribed/0/curve"},
      {"key of material", "/bodies/0/material/"}, {"key of body", "/bodies/0/"},    {"key of scene", "/"},
      {"key of shape", "/tools/0/shape/"}};
  for (const Lacking& entry : lacking_table()) {
    const std::string where(entry.where);
    if (where == "surface" || where == "mesh") continue;
    for (const std::string& word : words_of(entry)) {
      const bool key = where.starts_with("key of ");
      const std::string said = key ? message_with(place.at(where) + word, 1) : message_with(place.at(where), word);
      const std::string end =
          "; this version has no " + std::string(entry.missing) + ": the nearest is " + std::string(entry.nearest);
      EXPECT_TRUE(said.ends_with(end)) << word << ": " << said;
      EXPECT_NE(said.find(key ? "unknown key" : "expected one of "), std::string::npos) << said;
      EXPECT_EQ(said.find("did you mean"), std::string::npos) << "two suggestions: " << said;
    }
  }
  EXPECT_NE(message_with("/bodies/0/material/law", "Kelvin-Voigt").find("\"viscosity\""), std::string::npos);
  EXPECT_NE(message_with("/integrator", "implicit_euler").find("no implicit integrator"), std::string::npos);
  EXPECT_EQ(message_with("/bodies/0/element", "hex9").find("this version"), std::string::npos);
  EXPECT_NE(message_with("/bodies/0/element", "hex9").find("did you mean"), std::string::npos);
}

TEST(Lacking, FilesOfOtherKindsAreToldWhatToUse) {
  const test::TempFolder folder;
  const auto said = [&](const char* name, bool surface) {
    const std::filesystem::path file = folder.write(name, "no mesh\n");
    return test::error_of([&] {
      if (surface) {
        static_cast<void>(read_surface(file));
      } else {
        static_cast<void>(read_volume(file));
      }
    });
  };
  EXPECT_NE(said("a.msh", true).find("the nearest is the key \"mesh\""), std::string::npos) << said("a.msh", true);
  EXPECT_NE(said("a.STEP", true).find("no reader of CAD models"), std::string::npos);
  EXPECT_NE(said("a.stl", false).find("the nearest is the key \"surface\""), std::string::npos);
  EXPECT_NE(said("a.inp", false).find(".vtu or .msh"), std::string::npos);
  EXPECT_EQ(said("a.xyz", false).find("this version"), std::string::npos);
}

}  // namespace
}  // namespace pliant
