#include "scene/described_keys.h"

#include <fmt/format.h>

#include <cmath>

namespace pliant {
namespace {

constexpr double kSmallest = 1e-30, kLargest = 1e30;

std::string unit_text(const Key& key) { return key.unit[0] != 0 ? fmt::format(" [{}]", key.unit) : ""; }

}  // namespace

bool within(double x, const Range& r) {
  const double least = r.above && r.least == 0 ? kSmallest : r.least;
  const bool over = r.above && r.least != 0 ? x > least : x >= least;
  return over && (r.below ? x < r.most : x <= r.most);
}

std::string range_text(const Key& key, bool whole) {
  const Range& r = key.range;
  if (whole) return fmt::format("from {} to {}", std::llround(r.least), std::llround(r.most));
  if (r.least == r.most) return fmt::format("{:g}", r.least);
  if (r.most < kLargest)
    return fmt::format("{:g} {} {} {} {:g}", r.least, r.above ? "<" : "<=", key.name, r.below ? "<" : "<=", r.most);
  if (r.least > -kLargest) return fmt::format("{} {:g}", r.above ? ">" : ">=", r.least);
  return "";
}

std::string expected_text(const Key& key, bool whole) {
  const Range& r = key.range;
  const std::string range = range_text(key, whole);
  if (r.least == r.most && r.also) return fmt::format("{} or {:g}", range, *r.also);
  const char* const kind = whole ? "a whole number" : r.most < kLargest ? "a number with" : "a number";
  const std::string number = range.empty() ? kind : fmt::format("{} {}", kind, range);
  if (r.word != nullptr) return fmt::format("\"{}\" or {}{}", r.word, number, unit_text(key));
  return r.also ? fmt::format("{}, or {:g}", number, *r.also) : number;
}

double read_number(const Reader& field, const Key& key, bool whole) {
  const Range& r = key.range;
  if (r.word != nullptr && field.json() == r.word) return *r.also;
  const std::string expected = expected_text(key, whole);
  if (whole) {
    const double x = field.json().is_number() ? field.json().get<double>() : NAN;
    if (!within(x, r) || x != std::floor(x)) field.fail(expected);
    return x;
  }
  const double x = field.number(expected);
  if (r.also && r.word == nullptr && x == *r.also) return x;
  if (!within(x, r)) field.fail(r.above && r.least == 0 && x > 0 && x < kSmallest ? "a number of at least 1e-30" : expected);
  return x;
}

std::string ReadKeys::missing(const Key& key) {
  const std::string about = key.about;
  return about.substr(0, about.find_first_of(",;:")) + unit_text(key);
}

void ReadKeys::read(const Reader& field, const Key& /*key*/, std::string& member) {
  member = field.text("a name");
  if (member.empty()) field.fail("a name");
}

void ReadKeys::read(const Reader& field, const Key& /*key*/, std::array<Vec3d, 3>& member) {
  const char* const expected = "three rows of three numbers";
  const std::vector<Reader> rows = field.items(expected);
  if (rows.size() != 3) field.fail(expected);
  member = {rows[0].vec3(expected), rows[1].vec3(expected), rows[2].vec3(expected)};
}

void ReadKeys::read(const Reader& field, const Key& /*key*/, std::array<bool, 3>& axes) {
  const char* const expected = "one to three different letters of xyz, such as \"xz\"";
  axes = {false, false, false};
  for (const char c : field.text(expected)) {
    if (c < 'x' || c > 'z' || axes[c - 'x']) field.fail(expected);
    axes[c - 'x'] = true;
  }
}

void ReadKeys::read(const Reader& field, const Key& key, PerElement& member) {
  if (!field.json().is_object()) {
    member.value = read_number(field, key, false);
    return;
  }
  field.expect_object("element_field");
  member.field = field.at("field", "the name of an array of the mesh").text("the name of an array of the mesh");
}

std::string axes_text(const std::array<bool, 3>& axes) {
  std::string text;
  for (int c = 0; c < 3; ++c) {
    if (axes[c]) text += "xyz"[c];
  }
  return text;
}

}  // namespace pliant
