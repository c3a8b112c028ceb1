// What scenes/schema.json and docs/scene.md say of each described key (scene/described.h).
#pragma once
#include <gtest/gtest.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

#include "scene/described_keys.h"

namespace pliant::tables_test {

using Json = nlohmann::ordered_json;

inline std::string code(const std::string& word) { return "`" + word + "`"; }

/// Whether a key has a default, which is what the struct has: not where that stands for one that is not there.
template <class Member>
bool has_default(const Key& key, const Member& standard) {
  if (key.required || key.standard != nullptr) return false;
  if constexpr (std::is_arithmetic_v<Member>) {
    const auto x = static_cast<double>(standard);
    if (!key.range.absent) return true;
    EXPECT_EQ(x, *key.range.absent) << key.name << ": what is not written is what a reader does without it";
    return std::is_same_v<Member, bool> || within(x, key.range) || x == key.range.also;
  }
  return std::is_same_v<Member, Vec3d>;
}

/// The definition of each described key, in the place where the schema has it.
struct SchemaKeys {
  Json& properties;
  const char* of = "";  ///< before each description

  template <class Member>
  void operator()(const Member& standard, const Key& key) const {
    Json entry{{"description", about(key)}};
    add_kind(entry, key, standard);
    if (has_default(key, standard)) entry["default"] = value_of(key, standard);
    properties[key.name] = entry;
  }
  template <class Enum>
  void operator()(const Enum& standard, const Words<Enum>& words, const Key& key) const {
    properties[key.name] = {{"description", about(key)}, {"enum", words_only(words)}};
    if (key.standard == nullptr && !key.range.absent && !key.required)
      properties[key.name]["default"] = word_of(words, standard);
  }

 private:
  [[nodiscard]] std::string about(const Key& key) const {
    const std::string standard = key.standard != nullptr ? std::string("; by default ") + key.standard : "";
    const std::string plain = std::regex_replace(key.about + standard, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");
    std::string text = of + std::regex_replace(plain, std::regex("`\"?([^`\"]*)\"?`"), "$1");
    if (of[0] == 0 && key.about[0] != '`') text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text + (key.unit[0] != 0 ? " [" + std::string(key.unit) + "]" : "");
  }
  template <class Member>
  static Json value_of(const Key& key, const Member& standard) {
    if constexpr (std::is_arithmetic_v<Member>) {
      if (key.range.word != nullptr && static_cast<double>(standard) == *key.range.also) return key.range.word;
      return standard;
    }
    return {0, 0, 0};
  }
  static void add_kind(Json& entry, const Key& /*key*/, const Vec3d& /*standard*/) { entry["$ref"] = "#/$defs/vec3"; }
  static void add_kind(Json& entry, const Key& /*key*/, const std::array<Vec3d, 3>& /*standard*/) {
    entry.update({{"type", "array"}, {"minItems", 3}, {"maxItems", 3}, {"items", {{"$ref", "#/$defs/vec3"}}}});
  }
  static void add_kind(Json& entry, const Key& /*key*/, const std::array<bool, 3>& standard) {
    const char* const pattern = "^(x?y?z?|x?z?y?|y?x?z?|y?z?x?|z?x?y?|z?y?x?)$";
    entry.update({{"type", "string"}, {"pattern", pattern}, {"minLength", 1}, {"default", axes_text(standard)}});
  }
  static void add_kind(Json& entry, const Key& /*key*/, const std::string& /*standard*/) {
    entry.update({{"type", "string"}, {"minLength", 1}});
  }
  static void add_kind(Json& entry, const Key& key, const PerElement& /*standard*/) {
    Json number;
    add_kind(number, key, double{});
    entry["oneOf"] = {number, {{"$ref", "#/$defs/element_field"}}};
  }
  template <class T>
  static void add_kind(Json& entry, const Key& key, const std::optional<T>& /*standard*/) {
    add_kind(entry, key, T{});
  }
  template <class Number>
  static void add_kind(Json& entry, const Key& key, const Number& /*standard*/) {
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

/// The row of each described key, in the table behind an anchor.
struct DocumentRows {
  std::string& text;
  const char* anchor;
  const char* before = "";  ///< what stands in columns before the key
  const char* after = "";   ///< and between it and its unit

  template <class Member>
  void operator()(const Member& standard, const Key& key) const {
    std::string value = key.required ? "required" : "none";
    if (has_default(key, standard)) value = value_of(key, standard);
    set(key, value, allowed(key, standard));
  }
  template <class Enum>
  void operator()(const Enum& standard, const Words<Enum>& words, const Key& key) const {
    std::string allowed;
    for (const Word<Enum>& w : words) allowed += (allowed.empty() ? "" : ", ") + code(Json(w.word).dump());
    set(key, key.required ? "required" : key.range.absent ? "none" : code(Json(word_of(words, standard)).dump()), allowed);
  }

 private:
  static std::string allowed(const Key& /*key*/, bool /*standard*/) { return ""; }
  static std::string allowed(const Key& /*key*/, const Vec3d& /*standard*/) { return "three numbers"; }
  static std::string allowed(const Key& /*key*/, const std::array<Vec3d, 3>& /*standard*/) {
    return "three rows of three numbers";
  }
  static std::string allowed(const Key& /*key*/, const std::array<bool, 3>& /*standard*/) {
    return "one to three different letters of xyz";
  }
  static std::string allowed(const Key& /*key*/, const std::string& /*standard*/) { return "a name"; }
  static std::string allowed(const Key& key, const PerElement& /*standard*/) {
    return allowed(key, double{}) + ", or `{\"field\": \"E\"}`";
  }
  template <class T>
  static std::string allowed(const Key& key, const std::optional<T>& /*standard*/) {
    return allowed(key, T{});
  }
  template <class Number>
  static std::string allowed(const Key& key, const Number& /*standard*/) {
    const Range& r = key.range;
    std::string text = range_text(key, std::is_integral_v<Number>);
    if (std::is_integral_v<Number>) text = "whole number " + text;
    if (text.empty()) text = "a number";
    if (r.also && r.least == r.most) return text + " or " + short_text(*r.also);
    if (r.also) return (r.word != nullptr ? code(Json(r.word).dump()) : short_text(*r.also)) + ", or " + text;
    return text;
  }
  template <class Member>
  static std::string value_of(const Key& key, const Member& standard) {
    if constexpr (std::is_same_v<Member, bool>) return code(Json(standard).dump());
    if constexpr (std::is_arithmetic_v<Member>) {
      const auto x = static_cast<double>(standard);
      return key.range.word != nullptr && x == *key.range.also ? code(Json(key.range.word).dump()) : short_text(x);
    }
    return code("[0, 0, 0]");
  }
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
    if (key.standard != nullptr) standard = key.standard;
    if (!allowed.empty()) allowed += "; ";
    const std::string example = code(Json(key.name).dump() + ": " + key.example);
    text.replace(from + 1, end - from - 1,
                 first + " " + key.unit + (key.unit[0] != 0 ? " " : "") + "| " + standard + " | " + allowed + key.about +
                     " | " + example + " |");
  }
};

}  // namespace pliant::tables_test
