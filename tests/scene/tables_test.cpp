// What scenes/schema.json and docs/scene.md say about laws and words is written from the tables of the code. After a change of
// those run this test once with PLIANT_WRITE_TABLES=1, which writes both files anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scene/described_keys.h"
#include "support/source_dir.h"

namespace pliant::tables_test {
namespace {

using Json = nlohmann::ordered_json;

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

/// A value on one line if that ends within 128 columns, else one member a line. `around`: what stands beside it on its line.
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

/// Whether a key has a default, which is what the struct has: not where that stands for one that is not there.
template <class Member>
bool has_default(const Key& key, const Member& standard) {
  if (key.required || key.standard != nullptr) return false;
  if constexpr (std::is_arithmetic_v<Member>) {
    const auto x = static_cast<double>(standard);
    if (!key.range.absent || std::is_same_v<Member, bool>) return true;
    EXPECT_EQ(x, *key.range.absent) << key.name << ": what is not written is what a reader does without it";
    return within(x, key.range) || x == key.range.also;
  }
  return std::is_same_v<Member, Vec3d>;
}

/// The definition of each described key, in the place where the schema has it.
struct SchemaKeys {
  Json& properties;

  template <class Member>
  void operator()(const Member& standard, const Key& key) const {
    Json entry{{"description", key.about + (key.unit[0] != 0 ? " [" + std::string(key.unit) + "]" : "")}};
    if constexpr (std::is_arithmetic_v<Member>) {
      add_number(entry, key, standard);
    } else {
      entry["$ref"] = "#/$defs/vec3";
    }
    if (has_default(key, standard)) entry["default"] = value_of(key, standard);
    properties[key.name] = entry;
  }
  template <class Enum>
  void operator()(const Enum& standard, const Words<Enum>& words, const Key& key) const {
    properties[key.name] = {{"description", key.about}, {"enum", words_only(words)}};
    if (key.standard == nullptr && !key.range.absent) properties[key.name]["default"] = word_of(words, standard);
  }

 private:
  template <class Member>
  static Json value_of(const Key& key, const Member& standard) {
    if constexpr (std::is_arithmetic_v<Member>) {
      if (key.range.word != nullptr && static_cast<double>(standard) == *key.range.also) return key.range.word;
      return standard;
    }
    return {0, 0, 0};
  }
  template <class Number>
  static void add_number(Json& entry, const Key& key, const Number& /*standard*/) {
    Json number{{"type", std::is_same_v<Number, bool> ? "boolean" : std::is_integral_v<Number> ? "integer" : "number"}};
    const Range& r = key.range;
    const auto bound = [](double x) { return std::is_integral_v<Number> ? Json(static_cast<std::int64_t>(x)) : Json(x); };
    if (!std::is_same_v<Number, bool>) {
      // No larger number than 1e30 is read, and no positive one below 1e-30.
      if (r.above && r.least == 0) {
        number["minimum"] = 1e-30;
      } else {
        number[r.above ? "exclusiveMinimum" : "minimum"] = bound(r.least);
      }
      number[r.below ? "exclusiveMaximum" : "maximum"] = bound(r.most);
    }
    if (r.also && r.least == r.most) {
      entry["enum"] = {bound(r.least), bound(*r.also)};
    } else if (r.also) {
      entry["oneOf"] = {{{"const", r.word != nullptr ? Json(r.word) : bound(*r.also)}}, number};
    } else {
      entry.update(number);
    }
  }
};

TEST(Tables, SchemaHasTheLawsAndTheWordsOfTheCode) {
  Json schema = Json::parse(file_text("scenes/schema.json"));
  const auto keys = [&schema](const char* part) { return SchemaKeys{schema["$defs"][part]["properties"]}; };
  describe_scene(SchemaKeys{schema["properties"]}, Scene());
  describe_run(SchemaKeys{schema["properties"]}, Scene());
  describe_relaxation(keys("relaxation"), Relaxation());
  describe_solver(keys("solver"), StaticSolver());
  describe_view(keys("view"), SceneView());
  describe_blade(keys("blade"), Blade());
  describe_body(keys("body"), Body());
  describe_lattice(keys("lattice"), LatticeSpec());
  describe_material(keys("material"), Material());
  describe_tearing(keys("material"), Material());
  describe_friction(keys("tissue_contact"), TissueContact());
  describe_tool(keys("contact_tool"), ContactTool());
  describe_contact_law(keys("contact"), ContactTool());
  describe_growth(keys("model"), DeformationModel());
  describe_interface(keys("model"), DeformationModel());
  describe_regions(keys("model"), DeformationModel());
  describe_alpha(keys("model"), DeformationModel());
  describe_stiffness(keys("stiffness"), DeformationModel());
  set_laws(schema["$defs"]["material"]);
  expect_file("scenes/schema.json", pretty(schema) + "\n");
}

// --- docs/scene.md ---

std::string code(const std::string& word) { return "`" + word + "`"; }

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
  std::string text = "| element | what it is |\n|---|---|\n";
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

/// The row of each described key, in the table behind an anchor.
struct DocumentRows {
  std::string& text;
  const char* anchor;
  const char* before = "";  ///< what stands in columns before the key
  const char* after = "";   ///< and between it and its unit

  template <class Member>
  void operator()(const Member& standard, const Key& key) const {
    std::string allowed, value = has_default(key, standard) ? "" : key.required ? "required" : "none";
    if constexpr (std::is_same_v<Member, bool>) {
      value = code(Json(standard).dump());
    } else if constexpr (std::is_arithmetic_v<Member>) {
      const Range& r = key.range;
      allowed = range_text(key, std::is_integral_v<Member>);
      if (std::is_integral_v<Member>) allowed = "whole number " + allowed;
      if (allowed.empty()) allowed = "a number";
      if (r.also && r.least == r.most) {
        allowed += " or " + short_text(*r.also);
      } else if (r.also) {
        allowed = (r.word != nullptr ? code(Json(r.word).dump()) : short_text(*r.also)) + ", or " + allowed;
      }
      const bool as_word = r.word != nullptr && static_cast<double>(standard) == *r.also;
      if (value.empty()) value = as_word ? code(Json(r.word).dump()) : short_text(static_cast<double>(standard));
    } else {
      allowed = "three numbers";
      if (value.empty()) value = code("[0, 0, 0]");
    }
    set(key, value, allowed);
  }
  template <class Enum>
  void operator()(const Enum& standard, const Words<Enum>& words, const Key& key) const {
    std::string allowed;
    for (const Word<Enum>& w : words) allowed += (allowed.empty() ? "" : ", ") + code(Json(w.word).dump());
    set(key, key.range.absent ? "none" : code(Json(word_of(words, standard)).dump()), allowed);
  }

 private:
  static std::string short_text(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  }
  void set(const Key& key, std::string standard, std::string allowed) const {
    const std::string first = before + ("| " + code(key.name)) + " |" + after;
    const std::size_t from = text.find("\n" + first, text.find(anchor));
    ASSERT_NE(from, std::string::npos) << anchor << ' ' << key.name;
    const std::size_t end = text.find('\n', from + 1);
    std::string note = key.note != nullptr ? key.note : key.about;
    if (key.note == nullptr) note[0] = static_cast<char>(std::tolower(note[0]));
    if (key.standard != nullptr) standard = key.standard;
    if (!allowed.empty()) allowed += "; ";
    const std::string example = code(Json(key.name).dump() + ": " + key.example);
    text.replace(from + 1, end - from - 1,
                 first + " " + key.unit + (key.unit[0] != 0 ? " " : "") + "| " + standard + " | " + allowed + note + " | " +
                     example + " |");
  }
};

TEST(Tables, ScenesDocumentHasTheLawsAndElementsOfTheCode) {
  std::string text = file_text("docs/scene.md");
  const DocumentRows top{text, "## Top level"}, body{text, "\n## Body\n"}, material{text, "\n## Material\n"},
      hybrid{text, "\n## Model\n", "", " hybrid |"}, matching{text, "\n## Model\n", "", " hybrid, flsm |"};
  describe_scene(top, Scene());
  describe_run(top, Scene());
  describe_relaxation(DocumentRows{text, "`relaxation` (dynamic relaxation"}, Relaxation());
  describe_solver(DocumentRows{text, "`solver` (what"}, StaticSolver());
  describe_view(DocumentRows{text, "`view`, for pictures"}, SceneView());
  describe_blade(DocumentRows{text, "\n`blades`, each"}, Blade());
  describe_body(body, Body());
  describe_lattice(DocumentRows{text, "`lattice`, exactly"}, LatticeSpec());
  describe_material(material, Material());
  describe_tearing(material, Material());
  describe_tool(DocumentRows{text, "`tools`, at most 30"}, ContactTool());
  describe_contact_law(DocumentRows{text, "\n`contact`:"}, ContactTool());
  describe_growth(hybrid, DeformationModel());
  describe_interface(hybrid, DeformationModel());
  describe_regions(matching, DeformationModel());
  describe_alpha(matching, DeformationModel());
  replace_part(text, "elements", element_table());
  replace_part(text, "laws", law_tables());
  expect_file("docs/scene.md", text);
}

TEST(Tables, ScenesDocumentNamesEveryKeyAndWord) {
  const std::string text = file_text("docs/scene.md");
  const auto named = [&](const std::string& word) {
    return text.find("`" + word + "`") != std::string::npos || text.find("\"" + word + "\"") != std::string::npos;
  };
  for (const auto& [kind, words] : scene_words()) {
    for (const std::string& word : words) EXPECT_TRUE(named(word)) << kind << ' ' << word;
  }
  for (const auto& [kind, keys] : scene_keys()) {
    for (const std::string& key : keys) EXPECT_TRUE(named(key)) << kind << ' ' << key;
  }
}

}  // namespace
}  // namespace pliant::tables_test
