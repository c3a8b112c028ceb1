// What scenes/schema.json and docs/scene.md say about laws and words is written from the tables of the code. After a change of
// those run this test once with PLIANT_WRITE_TABLES=1, which writes both files anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scene/described_tables.h"
#include "support/source_dir.h"

namespace pliant::tables_test {
namespace {

std::string file_text(const std::string& name) {
  std::ifstream stream(std::filesystem::path(test::source_dir()) / name);
  EXPECT_TRUE(stream) << name;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void expect_file(const std::string& name, const std::string& expected) {
  if (std::getenv("PLIANT_WRITE_TABLES") != nullptr) {
    std::ofstream(std::filesystem::path(test::source_dir()) / name) << expected;
    return;
  }
  const std::string found = file_text(name);
  std::istringstream a(found), b(expected);
  std::string line, wanted;
  for (int number = 1; found != expected && std::getline(b, wanted); ++number) {
    if (!std::getline(a, line) || line != wanted) {
      FAIL() << name << " line " << number << " is\n  " << line << "\nand should be\n  " << wanted
             << "\nRun this test with PLIANT_WRITE_TABLES=1 to write the file anew.";
    }
  }
  EXPECT_EQ(found.size(), expected.size()) << name;
}

// --- scenes/schema.json ---

std::string compact(const Json& value) {
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [key, member] : value.items()) {
    text += (text.empty() ? "" : ", ") + (value.is_object() ? Json(key).dump() + ": " : "") + compact(member);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

/// A value on one line if that ends within 128 columns, else one member a line. `around`: what stands on the same line.
std::string pretty(const Json& value, std::size_t indent = 0, std::size_t around = 0) {
  std::string line = compact(value);
  if (!value.is_structured() || indent + around + line.size() <= 128) return line;
  std::string text;
  std::size_t left = value.size();
  for (const auto& [key, member] : value.items()) {
    const std::string name = value.is_object() ? Json(key).dump() + ": " : "";
    --left;
    text += std::string(indent + 2, ' ') + name + pretty(member, indent + 2, name.size() + (left > 0 ? 1 : 0)) +
            (left > 0 ? ",\n" : "\n");
  }
  return (value.is_object() ? "{\n" : "[\n") + text + std::string(indent, ' ') + (value.is_object() ? "}" : "]");
}

Json bounds(const ParameterInfo& p) {
  Json number{{"description", std::string(p.what) + " [" + p.unit + "]"}};
  if (p.lower == least_modulus) {
    number["exclusiveMinimum"] = 0;
  } else {
    number["minimum"] = p.lower;
  }
  number["maximum"] = p.upper;
  return number;
}

/// Exactly these elastic constants.
Json only(const std::vector<std::string>& keys, const Json& law) {
  Json others = Json::array();
  for (const std::string& key : elastic_keys()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) others.push_back({{"required", {key}}});
  }
  return {{"properties", {{"law", law}}}, {"required", keys}, {"not", {{"anyOf", others}}}};
}

void set_laws(Json& material) {
  Json properties{{"law", {{"enum", words_only(law_words())}, {"default", to_string(Material().law)}}}};
  for (const std::string& key : moduli_keys()) properties[key] = material["properties"][key];
  Json ways = Json::array();
  Json moduli{{"enum", Json::array()}};
  for (const Law law : all_laws()) {
    if (law_info(law).takes_moduli) moduli["enum"].push_back(to_string(law));
  }
  for (const auto& pair : {std::array{"young", "poisson"}, std::array{"lambda", "mu"}, std::array{"mu", "kappa"}}) {
    ways.push_back(only({pair.begin(), pair.end()}, moduli));
  }
  for (const Law law : all_laws()) {
    const LawInfo& info = law_info(law);
    if (info.takes_moduli) continue;
    ways.push_back(only(elastic_keys(info), {{"const", info.word}}));
    ways.back()["required"].insert(ways.back()["required"].begin(), "law");
    for (const ParameterInfo& p : info.parameters) {
      if (!properties.contains(p.name)) {
        properties[p.name] = {{"description", std::string("A parameter of ") + info.word}, {"type", "number"}};
      } else if (properties[p.name]["description"].get<std::string>().rfind("A parameter of ", 0) == 0) {
        properties[p.name]["description"] = properties[p.name]["description"].get<std::string>() + ", " + info.word;
      }
      ways.back()["properties"][p.name] = bounds(p);
    }
  }
  for (const auto& [key, value] : material["properties"].items()) {
    if (!properties.contains(key)) {
      const std::vector<std::string> known = scene_keys().at("material");
      if (std::find(known.begin(), known.end(), key) != known.end()) properties[key] = value;
    }
  }
  material["properties"] = properties;
  material["oneOf"] = ways;
}

TEST(Tables, SchemaHasTheLawsAndTheWordsOfTheCode) {
  Json schema = Json::parse(file_text("scenes/schema.json"));
  const auto keys = [&schema](const char* part, const char* of = "") {
    return SchemaKeys{schema["$defs"][part]["properties"], of};
  };
  describe_scene(SchemaKeys{schema["properties"]}, Scene());
  describe_run(SchemaKeys{schema["properties"]}, Scene());
  describe_relaxation(keys("relaxation"), Relaxation());
  describe_solver(keys("solver"), StaticSolver());
  describe_view(keys("view"), SceneView());
  describe_blade(keys("blade"), Blade());
  describe_change(keys("change"), ChangePlace());
  describe_gravity(keys("gravity"), Scene());
  for (const char* part : {"gravity", "prescribed", "force", "pressure"}) describe_curve(keys(part), Curve());
  describe_axes(keys("fixed"), Fixed());
  describe_axes(keys("prescribed"), Prescribed());
  describe_rotation(keys("rotation"), Rotation());
  describe_field(keys("field"), AffineField());
  describe_force(keys("force"), Force());
  describe_pressure(keys("pressure"), Pressure());
  describe_place(keys("probe"), SceneProbe());
  describe_pace(keys("probe_every"), SceneProbes());
  describe_body(keys("body"), Body());
  describe_lattice(keys("lattice"), LatticeSpec());
  describe_membrane(keys("membrane"), Membrane());
  describe_vessel(keys("vessel"), Vessel());
  describe_elastic(keys("material"), ElasticConstants());
  describe_material(keys("material"), Material());
  describe_friction(keys("tissue_contact"), TissueContact());
  describe_tool(keys("contact_tool"), ContactTool());
  describe_contact_law(keys("contact"), ContactTool());
  describe_type(keys("model"), DeformationModel());
  describe_growth(keys("model", "hybrid: "), DeformationModel());
  describe_interface(keys("model", "hybrid: "), DeformationModel());
  describe_regions(keys("model", "hybrid, flsm: "), DeformationModel());
  describe_alpha(keys("model", "hybrid, flsm: "), DeformationModel());
  describe_stiffness(keys("stiffness"), DeformationModel());
  describe_network(keys("model", "mass-spring: "), DeformationModel());
  describe_spring(keys("spring"), Spring());
  describe_join(keys("join"), Join());
  set_laws(schema["$defs"]["material"]);
  expect_file("scenes/schema.json", pretty(schema) + "\n");
}

// --- docs/scene.md ---

std::string allowed(const ParameterInfo& p) {
  if (p.lower == least_modulus) return "> 0";
  if (p.lower == -most_modulus && p.upper == most_modulus) return "a number";
  std::ostringstream text;
  text << p.lower << " to " << p.upper;
  return text.str();
}

/// The laws, and the parameters of those that elastic constants do not determine.
std::string law_tables() {
  std::string laws = "| law | energy per volume at rest | given by | `tet4anp` | J <= 0 | as in |\n|---|---|---|---|---|---|\n";
  std::string parameters;
  for (const Law law : all_laws()) {
    const LawInfo& info = law_info(law);
    std::string given;
    if (info.takes_moduli) {
      given = "two elastic constants";
    } else {
      for (const ParameterInfo& p : info.parameters) {
        given += (given.empty() ? "" : ", ") + code(p.name);
        parameters +=
            "| " + code(p.name) + " | " + code(info.word) + " | " + p.unit + " | " + allowed(p) + " | " + p.what + " |\n";
      }
    }
    laws += "| " + code(info.word) + " | " + info.energy + " | " + given + " | " + (info.volumetric ? "yes" : "no") + " | " +
            (info.invertible ? "finite" : "refused") + " | " + info.source + " |\n";
  }
  if (parameters.empty()) return laws;
  return laws + "\n| key | law | unit | allowed | meaning |\n|---|---|---|---|---|\n" + parameters;
}

std::string element_table() {
  std::string text = "| element | description |\n|---|---|\n";
  for (const Word<ElementKind>& w : element_words()) text += "| " + code(w.word) + " | " + w.what + " |\n";
  return text;
}

/// The part of a document between two marks.
void replace_part(std::string& text, const std::string& what, const std::string& part) {
  const std::string begin = "<!-- " + what + ": written by tests/scene/tables_test.cpp -->\n",
                    end = "<!-- end of the " + what + " -->\n";
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_NE(from, std::string::npos) << what;
  ASSERT_NE(to, std::string::npos) << what;
  text = text.substr(0, from + begin.size()) + part + text.substr(to);
}

TEST(Tables, ScenesDocumentHasTheLawsAndElementsOfTheCode) {
  std::string text = file_text("docs/scene.md");
  const char* const entries = "\n## Entries\n";
  const DocumentRows top{text, "## Top level"}, body{text, "\n## Body\n"}, material{text, "\n## Material\n"},
      hybrid{text, "\n## Model\n", "", " hybrid |"}, matching{text, "\n## Model\n", "", " hybrid, flsm |"};
  describe_scene(top, Scene());
  describe_run(top, Scene());
  describe_relaxation(DocumentRows{text, "`relaxation` (dynamic relaxation"}, Relaxation());
  describe_solver(DocumentRows{text, "`solver` (what"}, StaticSolver());
  describe_view(DocumentRows{text, "`view`, for pictures"}, SceneView());
  describe_blade(DocumentRows{text, "\n`blades`, each"}, Blade());
  describe_change(DocumentRows{text, "\n`changes`, each"}, ChangePlace());
  describe_rotation(DocumentRows{text, "\nA rotation moves"}, Rotation());
  describe_field(DocumentRows{text, "\nThe fields of `initial`"}, AffineField());
  describe_curve(DocumentRows{text, "\n## Curves\n"}, Curve());
  describe_axes(DocumentRows{text, entries, "| `fixed` "}, Fixed());
  describe_axes(DocumentRows{text, entries, "| `prescribed` "}, Prescribed());
  describe_force(DocumentRows{text, entries, "| `forces` "}, Force());
  describe_pressure(DocumentRows{text, entries, "| `pressures` "}, Pressure());
  describe_place(DocumentRows{text, "\n`probes`, each"}, SceneProbe());
  describe_body(body, Body());
  describe_lattice(DocumentRows{text, "`lattice`, exactly"}, LatticeSpec());
  describe_membrane(DocumentRows{text, "`membrane`, a thin"}, Membrane());
  describe_vessel(DocumentRows{text, "`vessels`, a list"}, Vessel());
  describe_elastic(material, ElasticConstants());
  describe_material(material, Material());
  describe_tool(DocumentRows{text, "`tools`, at most 29"}, ContactTool());
  describe_contact_law(DocumentRows{text, "\n`contact`:"}, ContactTool());
  describe_type(DocumentRows{text, "\n## Model\n", "", " |"}, DeformationModel());
  describe_growth(hybrid, DeformationModel());
  describe_interface(hybrid, DeformationModel());
  describe_regions(matching, DeformationModel());
  describe_alpha(matching, DeformationModel());
  describe_network(DocumentRows{text, "\n## Model\n", "", " mass-spring |"}, DeformationModel());
  describe_spring(DocumentRows{text, "\n`spring` of a mass-spring"}, Spring());
  describe_join(DocumentRows{text, "\n`joins`, each"}, Join());
  replace_part(text, "elements", element_table());
  replace_part(text, "laws", law_tables());
  expect_file("docs/scene.md", text);
}

TEST(Tables, ScenesDocumentNamesEveryKeyAndWord) {
  const std::string text = file_text("docs/scene.md");
  const auto named = [&](const std::string& word) {
    return text.find("`" + word + "`") != std::string::npos || text.find("\"" + word + "\"") != std::string::npos;
  };
  for (const std::string& word : words_only(quantity_words())) EXPECT_TRUE(named(word)) << word;
  for (const auto& [kind, keys] : scene_keys()) {
    for (const std::string& key : keys) EXPECT_TRUE(named(key)) << kind << ' ' << key;
  }
}

}  // namespace
}  // namespace pliant::tables_test
