// The rows of `pliant bench stability` as text.
#include <fmt/format.h>

#include "bench/stability/stability.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

std::string number(const json& value) { return value.is_null() ? "-" : fmt::format("{:.4g}", value.get<double>()); }

std::string parameters(const json& of) {
  std::string text;
  for (const auto& [key, value] : of.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value.is_string() ? value.get<std::string>() : number(value));
  }
  return text;
}

}  // namespace

std::string stability_table(const json& result) {
  std::string text;
  for (const json& sweep : result["sweeps"]) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", sweep["question"].get<std::string>());
    text += fmt::format("{:<9} {:<56} {:<24} {:>10} {:>10} {:>7}  {}\n", "method", "parameters", "limit of", "predicted",
                        "measured", "reached", "past it");
    for (const json& row : result["rows"]) {
      if (row["sweep"] != sweep["name"]) continue;
      text +=
          fmt::format("{:<9} {:<56} {:<24} {:>10} {:>10} {:>7}  {}\n", row["method"].get<std::string>(),
                      parameters(row["parameters"]), row["quantity"].get<std::string>(), number(row["predicted"]),
                      number(row["measured"]), row["reached"].get<bool>() ? "yes" : "no", row["outcome"].get<std::string>());
    }
  }
  return text;
}

}  // namespace pliant::bench
