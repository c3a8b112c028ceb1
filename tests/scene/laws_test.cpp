// Every law in a scene file: it comes back as it was, and what it lacks, what it does not take and what is out of bounds is
// named, by the loader and by the schema.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/keys.h"
#include "scene/schema_check.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using Json = nlohmann::json;

Scene scene_with(Law law) {
  Scene scene = parse_scene(R"({"format": "pliant-scene/1", "bodies": [{"surface": "a.obj", "lattice": {"spacing": 0.1},
      "material": {"young": 3000, "poisson": 0.45}}]})",
                            "s.json");
  scene.bodies[0].material.set_moduli(law, Moduli::from_bulk(1000, 50000));
  return scene;
}

class EveryLaw : public ::testing::Test {
 protected:
  EveryLaw() : schema_(Json::parse(std::ifstream(test::source_dir() + "/scenes/schema.json"))) {}

  /// Neither the loader nor the schema takes the file; the loader's message holds `text`.
  void expect_refused(const Json& file, const std::string& text) {
    const std::string message = test::error_of([&] { parse_scene(file.dump(), "s.json"); });
    EXPECT_NE(message.find(text), std::string::npos) << message << "\nshould hold " << text;
    EXPECT_FALSE(schema_.findings(file).empty()) << file["bodies"][0]["material"];
  }

  SchemaCheck schema_;
};

TEST_F(EveryLaw, ComesBackFromAFile) {
  for (const Law law : all_laws()) {
    const Scene scene = scene_with(law);
    const std::string text = scene_to_json(scene);
    for (const std::string& finding : schema_.findings(Json::parse(text))) ADD_FAILURE() << to_string(law) << finding;
    const Material back = parse_scene(text, "s.json").bodies[0].material;
    EXPECT_EQ(back.law, law);
    EXPECT_EQ(back.parameters, scene.bodies[0].material.parameters) << to_string(law);
    EXPECT_NEAR(back.moduli.mu, 1000, 1e-9) << to_string(law);
    EXPECT_NEAR(back.moduli.kappa, 50000, 1e-9) << to_string(law);
  }
}

TEST_F(EveryLaw, NeedsItsParametersWithinTheirBounds) {
  for (const Law law : all_laws()) {
    const LawInfo& info = law_info(law);
    if (info.takes_moduli) continue;
    const Json good = Json::parse(scene_to_json(scene_with(law)));
    for (const ParameterInfo& p : info.parameters) {
      Json bad = good;
      bad["bodies"][0]["material"].erase(p.name);
      expect_refused(bad, std::string("/bodies/0/material: got no \"") + p.name + "\", expected the " + p.what);
      bad["bodies"][0]["material"][p.name] = "soft";
      expect_refused(bad, std::string("/bodies/0/material/") + p.name + ": got \"soft\", expected a number");
      bad["bodies"][0]["material"][p.name] = 2e30;
      expect_refused(bad, std::string("/bodies/0/material/") + p.name + ": got 2e+30");
      if (p.lower != least_modulus) continue;
      bad["bodies"][0]["material"][p.name] = 0;
      expect_refused(bad, std::string("/bodies/0/material/") + p.name + ": got 0, expected a number > 0");
    }
  }
}

TEST_F(EveryLaw, RefusesConstantsThatItDoesNotTake) {
  for (const Law law : all_laws()) {
    const Json good = Json::parse(scene_to_json(scene_with(law)));
    const std::vector<std::string> own = elastic_keys(law_info(law));
    for (const std::string& key : elastic_keys()) {
      if (std::find(own.begin(), own.end(), key) != own.end()) continue;
      Json bad = good;
      bad["bodies"][0]["material"][key] = 0.25;
      expect_refused(bad,
                     "/bodies/0/material/" + key + ": got 0.25, expected no \"" + key + "\" with the law " + to_string(law));
    }
  }
}

}  // namespace
}  // namespace pliant
