// Cells of the tables that benchmarks print.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace pliant::bench {

inline std::string words(const nlohmann::json& row, const char* key) { return row.at(key).get<std::string>(); }

/// Empty where the row has no such number.
inline std::string number(const nlohmann::json& row, const char* key, int digits, double factor = 1) {
  if (!row.contains(key) || row[key].is_null()) return "";
  return fmt::format("{:.{}f}", factor * row[key].get<double>(), digits);
}

inline bool has_part(const nlohmann::json& rows, const char* part) {
  return std::any_of(rows.begin(), rows.end(), [part](const nlohmann::json& row) { return row["part"] == part; });
}

/// Tables below each other, each with its title.
inline std::string titled(const std::vector<std::pair<std::string, std::string>>& tables) {
  std::string text;
  for (const auto& [title, table] : tables) text += fmt::format("{}{}\n{}", text.empty() ? "" : "\n", title, table);
  return text;
}

}  // namespace pliant::bench
