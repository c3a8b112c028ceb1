#include "scene/described_keys.h"

#include <fmt/format.h>

#include <cctype>
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
  if (!within(x, r)) field.fail(x > 0 && x < kSmallest ? "a number of at least 1e-30" : expected);
  return x;
}

std::string ReadKeys::about(const Key& key) {
  std::string text = key.about + unit_text(key);
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace pliant
