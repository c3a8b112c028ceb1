// The rows of `pliant bench contact` as text.
#include <fmt/format.h>

#include <vector>

#include "bench/contact/contact.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

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
    const std::string name = rows.size() > few ? "  " + scene : scene.empty() ? test : test + ": " + scene;
    text += line(name, *row, word(*row));
    if (!message.empty()) text += fmt::format("    {}\n", message);
  }
  return text;
}

}  // namespace

std::string contact_table(const json& result) {
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
