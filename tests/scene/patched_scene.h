// A good scene with a hybrid body, changed in one place: what the loader and the schema say of it.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"
#include "scene/schema_check.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::model_test {

using Json = nlohmann::json;

inline const char* const good = R"({"format": "pliant-scene/1", "bodies": [
  {"name": "a", "surface": "a.obj", "lattice": {"spacing": 0.1}, "material": {"young": 3000, "poisson": 0.45},
   "model": {"type": "hybrid"}}]})";

/// The good scene with the members of an RFC 7386 merge patch: null removes a member.
inline std::string patched(const std::string& patch, const std::string& body = "{}") {
  Json scene = Json::parse(good);
  scene.merge_patch(Json::parse(patch));
  scene["bodies"][0].merge_patch(Json::parse(body));
  return scene.dump();
}

inline std::string with_model(const std::string& model, const std::string& patch = "{}") {
  Json scene = Json::parse(patched(patch));
  scene["bodies"][0]["model"] = Json::parse(model);
  return scene.dump();
}

inline std::string message(const std::string& text) {
  return test::error_of([&] { parse_scene(text, "dir/s.json"); });
}

inline const SchemaCheck& schema() {
  static const SchemaCheck check([] {
    std::ifstream stream(test::source_dir() + "/scenes/schema.json");
    return Json::parse(stream);
  }());
  return check;
}

inline void expect_refused(const std::string& text, const std::string& expected) {
  const std::string got = message(text);
  EXPECT_EQ(got.substr(0, 12 + expected.size()), "dir/s.json: " + expected) << text << "\n" << got;
  EXPECT_FALSE(schema().findings(Json::parse(text)).empty()) << text;
}

}  // namespace pliant::model_test
