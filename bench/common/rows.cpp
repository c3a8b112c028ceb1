#include "bench/common/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pliant/error.h"

namespace pliant::bench {

using nlohmann::json;

namespace {

/// JSON knows no infinity.
json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

std::string short_number(const json& value) { return value.is_null() ? "-" : fmt::format("{:.4g}", value.get<double>()); }

/// Error over bound: what is compared where bounds differ.
double share_of_bound(const json& row) {
  if (row["error"].is_null()) return row["ok"] == false ? HUGE_VAL : 0;
  const double error = row["error"].get<double>();
  return row["bound"].is_number() && row["bound"] > 0 ? error / row["bound"].get<double>() : error;
}

std::string line(const std::string& test, const json& row, const std::string& ok) {
  return fmt::format("{:>10} {:>10} {:>10} {:>9}  {:<13} {}\n", short_number(row["value"]), short_number(row["expected"]),
                     short_number(row["error"]), short_number(row["bound"]), ok, test);
}

/// Rows of one test, which is a line each where they are few, and otherwise the worst and all that fail.
std::string lines_of(const std::vector<const json*>& rows) {
  constexpr std::size_t few = 6;
  std::string text;
  const std::string test = (*rows.front())["test"].get<std::string>();
  const auto word = [](const json& row) { return row["ok"].is_null() ? "" : row["ok"] == true ? "ok" : "NOT OK"; };
  if (rows.size() > few) {
    const json* worst = rows.front();
    std::size_t asked = 0, good = 0;
    for (const json* row : rows) {
      asked += (*row)["ok"].is_boolean();
      good += (*row)["ok"] == true;
      if (share_of_bound(*row) > share_of_bound(*worst)) worst = row;
    }
    text += line(test + ", the worst", *worst, asked > 0 ? fmt::format("{} of {} ok", good, asked) : "");
  }
  for (const json* row : rows) {
    if (rows.size() > few && (*row)["ok"] != false) continue;
    const std::string scene = (*row)["scene"].get<std::string>(), message = (*row)["message"].get<std::string>();
    const std::string name = rows.size() > few ? fmt::format("  {}", scene)
                             : scene.empty()   ? test
                                               : fmt::format("{}: {}", test, scene);
    text += line(name, *row, word(*row));
    if (!message.empty()) text += fmt::format("    {}\n", message);
  }
  return text;
}

}  // namespace

void Rows::add(const std::string& test, const std::string& scene, json value, json expected, json error, json bound,
               const std::string& message) {
  json ok;
  if (!bound.is_null()) ok = error.is_number() && error.get<double>() <= bound.get<double>();
  if (!message.empty()) ok = false;
  rows_.push_back({{"part", part_},
                   {"test", test},
                   {"scene", scene},
                   {"value", std::move(value)},
                   {"expected", std::move(expected)},
                   {"error", std::move(error)},
                   {"bound", std::move(bound)},
                   {"ok", std::move(ok)},
                   {"message", message}});
}

void Rows::at_most(const std::string& test, const std::string& scene, double value, double bound) {
  add(test, scene, finite_or_null(value), 0.0, finite_or_null(std::abs(value)), bound);
}

void Rows::close_to(const std::string& test, const std::string& scene, double value, double expected, double bound) {
  add(test, scene, finite_or_null(value), finite_or_null(expected), finite_or_null(std::abs(value / expected - 1)), bound);
}

void Rows::at_least(const std::string& test, const std::string& scene, double value, double expected, double bound) {
  add(test, scene, finite_or_null(value), expected, finite_or_null(std::max(0.0, 1 - value / expected)), bound);
}

void Rows::told(const std::string& test, const std::string& scene, double value) {
  add(test, scene, finite_or_null(value), {}, {}, {});
}

void Rows::failed(const std::string& test, const std::string& scene, const std::string& why) {
  add(test, scene, {}, {}, {}, {}, why);
}

void check_parts(const std::vector<std::string>& known, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::bad_input, fmt::format("--parts: got \"{}\", expected {}", name, fmt::join(known, ", ")));
  }
}

json summary_of(const json& rows) {
  int asked = 0, good = 0;
  for (const json& row : rows) {
    asked += row["ok"].is_boolean();
    good += row["ok"] == true;
  }
  return {{"rows", rows.size()}, {"asked", asked}, {"ok", good}};
}

std::string rows_table(const json& result) {
  std::string text;
  for (const json& part : result["parts"]) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", part["question"].get<std::string>());
    text += fmt::format("{:>10} {:>10} {:>10} {:>9}  {:<13} {}\n", "value", "expected", "error", "bound", "", "test");
    std::vector<std::string> tests;
    for (const json& row : result["rows"]) {
      if (row["part"] == part["name"] && (tests.empty() || std::find(tests.begin(), tests.end(), row["test"]) == tests.end()))
        tests.push_back(row["test"]);
    }
    for (const std::string& test : tests) {
      std::vector<const json*> rows;
      for (const json& row : result["rows"]) {
        if (row["part"] == part["name"] && row["test"] == test) rows.push_back(&row);
      }
      text += lines_of(rows);
    }
  }
  const json& s = result["summary"];
  return text + fmt::format("\n{} of {} rows with a bound keep it\n", s["ok"].get<int>(), s["asked"].get<int>());
}

}  // namespace pliant::bench
