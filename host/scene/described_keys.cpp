#include "scene/described_keys.h"

#include <cmath>

namespace pliant {
namespace {

constexpr double kSmallest = 1e-30, kLargest = 1e30;

bool within(double x, const Range& r) {
  const double least = r.above && r.least == 0 ? kSmallest : r.least;
  const bool over = r.above && r.least != 0 ? x > least : x >= least;
  return over && (r.below ? x < r.most : x <= r.most);
}

}  // namespace

std::string range_text(const Key& key, bool whole) {
  const Range& r = key.range;
  if (whole) return fmt::format("from {} to {}", std::llround(r.least), std::llround(r.most));
  if (r.most < kLargest)
    return fmt::format("{:g} {} {} {} {:g}", r.least, r.above ? "<" : "<=", key.name, r.below ? "<" : "<=", r.most);
  if (r.least > -kLargest) return fmt::format("{} {:g}", r.above ? ">" : ">=", r.least);
  return "";
}

std::string expected_text(const Key& key, bool whole) {
  const std::string range = range_text(key, whole);
  const char* const kind = whole ? "a whole number" : key.range.most < kLargest ? "a number with" : "a number";
  const std::string number = range.empty() ? kind : fmt::format("{} {}", kind, range);
  const std::string unit = key.unit[0] != 0 ? fmt::format(" [{}]", key.unit) : "";
  if (key.word != nullptr) return fmt::format("\"{}\" or {}{}", key.word, number, unit);
  return key.also ? fmt::format("{}, or {:g}", number, *key.also) : number;
}

double read_number(const Reader& field, const Key& key, bool whole) {
  if (key.word != nullptr && field.json() == key.word) return *key.also;
  const std::string expected = expected_text(key, whole);
  if (whole) {
    const double x = field.json().is_number() ? field.json().get<double>() : NAN;
    if (!within(x, key.range) || x != std::floor(x)) field.fail(expected);
    return x;
  }
  const double x = field.number(expected);
  if (key.also && key.word == nullptr && x == *key.also) return x;
  if (!within(x, key.range)) field.fail(x > 0 && x < kSmallest ? "a number of at least 1e-30" : expected);
  return x;
}

}  // namespace pliant
