// Enough of JSON Schema (draft 2020-12) to hold scenes/schema.json against scene files. A keyword it does not know is itself
// a finding, so the schema cannot outgrow the check unnoticed.
#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace pliant {

class SchemaCheck {
 public:
  using Json = nlohmann::json;
  explicit SchemaCheck(Json schema) : schema_(std::move(schema)) {}

  /// What is wrong with `value`, one line per finding; empty if it follows the schema.
  std::vector<std::string> findings(const Json& value) const {
    std::vector<std::string> list;
    check(schema_, value, "", list);
    return list;
  }

 private:
  bool fits(const Json& schema, const Json& value) const {
    std::vector<std::string> list;
    check(schema, value, "", list);
    return list.empty();
  }

  static bool has_type(const Json& value, const std::string& type) {
    if (type == "integer") return value.is_number_integer() || (value.is_number() && value == std::floor(value.get<double>()));
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "array") return value.is_array();
    if (type == "object") return value.is_object();
    return type == "null" && value.is_null();
  }

  bool any_type(const Json& types, const Json& value) const {
    if (types.is_string()) return has_type(value, types);
    return std::any_of(types.begin(), types.end(), [&](const Json& type) { return has_type(value, type); });
  }

  std::ptrdiff_t count_fits(const Json& schemas, const Json& value) const {
    return std::count_if(schemas.begin(), schemas.end(), [&](const Json& schema) { return fits(schema, value); });
  }

  void check(const Json& schema, const Json& value, const std::string& where, std::vector<std::string>& list) const {
    for (const auto& [word, rule] : schema.items()) {
      if (!holds(schema, word, rule, value)) list.push_back(where + ": " + word + " " + rule.dump().substr(0, 120));
    }
    if (schema.contains("$ref")) {
      check(schema_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value, where, list);
    }
    descend(schema, value, where, list);
  }

  void descend(const Json& schema, const Json& value, const std::string& where, std::vector<std::string>& list) const {
    if (value.is_object()) {
      for (const auto& [key, member] : value.items()) {
        if (schema.contains("properties") && schema["properties"].contains(key)) {
          check(schema["properties"][key], member, where + "/" + key, list);
        } else if (schema.value("additionalProperties", true) == false) {
          list.push_back(where + ": unknown key " + key);
        }
      }
    }
    for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
      if (schema.contains("prefixItems") && i < schema["prefixItems"].size()) {
        check(schema["prefixItems"][i], value[i], where + "/" + std::to_string(i), list);
      } else if (schema.contains("items")) {
        check(schema["items"], value[i], where + "/" + std::to_string(i), list);
      }
    }
  }

  /// One keyword that looks at the value itself; those that look into it are in descend.
  bool holds(const Json& schema, const std::string& word, const Json& rule, const Json& value) const {
    static const std::set<std::string> elsewhere{"$schema",     "$defs",       "$ref",       "title",
                                                 "description", "default",     "properties", "additionalProperties",
                                                 "items",       "prefixItems", "then"};
    if (elsewhere.count(word) > 0) return true;
    if (word == "type") return any_type(rule, value);
    if (word == "const") return value == rule;
    if (word == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (word == "oneOf") return count_fits(rule, value) == 1;
    if (word == "allOf") return count_fits(rule, value) == static_cast<std::ptrdiff_t>(rule.size());
    if (word == "anyOf") return count_fits(rule, value) > 0;
    if (word == "not") return !fits(rule, value);
    if (word == "if") return !fits(rule, value) || fits(schema.at("then"), value);
    if (word == "required")
      return !value.is_object() ||
             std::all_of(rule.begin(), rule.end(), [&](const Json& key) { return value.contains(key.get<std::string>()); });
    if (value.is_number()) {
      if (word == "minimum") return value >= rule;
      if (word == "maximum") return value <= rule;
      if (word == "exclusiveMinimum") return value > rule;
      if (word == "exclusiveMaximum") return value < rule;
    }
    if (value.is_array()) {
      if (word == "minItems") return value.size() >= rule;
      if (word == "maxItems") return value.size() <= rule;
      if (word == "uniqueItems") return std::set<Json>(value.begin(), value.end()).size() == value.size();
      if (word == "contains")
        return std::any_of(value.begin(), value.end(), [&](const Json& item) { return fits(rule, item); });
    }
    if (value.is_string()) {
      if (word == "minLength") return value.get<std::string>().size() >= rule;
      if (word == "maxLength") return value.get<std::string>().size() <= rule;
      if (word == "pattern") return std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()));
    }
    static const std::set<std::string> typed{"minimum",   "maximum",   "exclusiveMinimum", "exclusiveMaximum",
                                             "minItems",  "maxItems",  "uniqueItems",      "contains",
                                             "minLength", "maxLength", "pattern"};
    return typed.count(word) > 0;  // a known keyword for another type does not apply; an unknown one is a finding
  }

  Json schema_;
};

}  // namespace pliant
