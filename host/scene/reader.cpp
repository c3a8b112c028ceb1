#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh_io/lacking.h"
#include "pliant/error.h"
#include "scene/json_text.h"
#include "scene/parts.h"

namespace pliant {

namespace {

constexpr double largest = 1e30;
constexpr double smallest = 1e-30;

/// The value as it may stand in a message: whole when short, otherwise its kind and size.
std::string shown(const nlohmann::json& value) {
  if (value.is_object()) {
    if (value.empty()) return "{}";
    return fmt::format("an object with {} key{}", value.size(), value.size() == 1 ? "" : "s");
  }
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (value.is_array() && value.size() > 8) return fmt::format("an array of {} values", value.size());
  return shortened(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string with_hint(const std::string& expected, const std::string& hint) {
  return hint.empty() ? expected : fmt::format("{} (did you mean \"{}\"?)", expected, hint);
}

/// The key of a value as the table of what is lacking has it: `type` stands in several objects.
std::string key_of(const std::string& pointer) {
  const std::size_t last = pointer.rfind('/');
  if (last == std::string::npos) return pointer;
  std::string key = pointer.substr(last + 1);
  if (key != "type" || last == 0) return key;
  const std::size_t before = pointer.rfind('/', last - 1);
  return pointer.substr(before == std::string::npos ? 0 : before + 1);
}

}  // namespace

void Reader::fail(const std::string& expected) const { fail(shown(value_), expected); }

void Reader::fail(const std::string& got, const std::string& expected) const {
  const std::string where = pointer_.empty() ? "top level" : shortened(pointer_, 200);
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}: got {}, expected {}", file_, where, got, expected));
}

void Reader::expect_object(const std::string& kind) const {
  const std::vector<std::string>& allowed = scene_keys().at(kind);
  if (!value_.is_object()) fail(fmt::format("an object with the keys {}", listed(allowed)));
  for (const auto& [key, member] : value_.items()) {
    bool known = false;
    for (const std::string& word : allowed) known = known || word == key;
    if (!known) {
      if (kind == "scene" && key == "tool") fail("the key \"tool\"", "\"focus\", which is its name since 0.2.0");
      const std::string quoted = shortened(nlohmann::json(key).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
      const std::string without = lacking("key of " + kind, key);
      const std::string hint = without.empty() ? nearest(key, allowed) : "";
      fail("the unknown key " + quoted, with_hint("one of " + listed(allowed), hint) + without);
    }
  }
}

Reader Reader::at(const std::string& key, const std::string& expected) const {
  const auto found = value_.find(key);
  if (found == value_.end()) fail("no \"" + key + "\"", expected);
  return {*found, file_, pointer_to(pointer_, key)};
}

std::vector<Reader> Reader::items(const std::string& expected, std::size_t least) const {
  if (!value_.is_array() || value_.size() < least) fail(expected);
  std::vector<Reader> list;
  list.reserve(value_.size());
  for (std::size_t i = 0; i < value_.size(); ++i) list.emplace_back(value_[i], file_, fmt::format("{}/{}", pointer_, i));
  return list;
}

double Reader::number(const std::string& expected) const {
  if (!value_.is_number()) fail(expected);
  const double x = value_.get<double>();
  if (!std::isfinite(x) || std::fabs(x) > largest) fail(expected + " of magnitude at most 1e30");
  return x;
}

double Reader::positive() const {
  const double x = number("a number > 0");
  if (!(x >= smallest)) fail(x > 0 ? "a number of at least 1e-30" : "a number > 0");
  return x;
}

double Reader::non_negative() const {
  const double x = number("a number >= 0");
  if (!(x >= 0)) fail("a number >= 0");
  return x;
}

std::int64_t Reader::integer(std::int64_t least, std::int64_t most) const {
  const std::string expected = fmt::format("a whole number from {} to {}", least, most);
  if (!value_.is_number()) fail(expected);
  const double x = value_.get<double>();
  // The double test comes first: it makes the conversion below safe for 1e300 and for unsigned values beyond int64.
  if (!(x >= static_cast<double>(least) && x <= static_cast<double>(most)) || x != std::floor(x)) fail(expected);
  return value_.get<std::int64_t>();
}

bool Reader::boolean() const {
  if (!value_.is_boolean()) fail("true or false");
  return value_.get<bool>();
}

std::string Reader::text(const std::string& expected) const {
  if (!value_.is_string()) fail(expected);
  std::string s = value_.get<std::string>();
  if (s.empty() || s.find('\0') != std::string::npos) fail(expected);
  return s;
}

Vec3d Reader::vec3(const std::string& expected) const {
  if (!value_.is_array() || value_.size() != 3) fail(expected);
  const std::vector<Reader> list = items(expected);
  return {list[0].number(), list[1].number(), list[2].number()};
}

void Reader::fail_word(const std::vector<std::string>& allowed) const {
  const std::string word = value_.is_string() ? value_.get<std::string>() : "";
  const std::string without = lacking(key_of(pointer_), word);
  fail(with_hint("one of " + listed(allowed), without.empty() ? nearest(word, allowed) : "") + without);
}

std::string read_name(const Reader& field, const std::string& what, const char* refused) {
  const std::string expected = "a name of 1 to 100 characters without " + (what.empty() ? "" : what + " or ") +
                               "control characters such as a line break";
  std::string name = field.text(expected);
  const bool control = std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; });
  if (control || name.size() > 100 || name.find_first_of(refused) != std::string::npos) field.fail(expected);
  return name;
}

}  // namespace pliant
