// The rows of `pliant bench deformation` as text.
#include "bench/common/table_cells.h"
#include "bench/deformation/deformation.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

std::string against(const json& row, const char* key, const char* limit) {
  if (!row.contains(limit)) return "";
  return fmt::format("{} {}", row.at(key).get<double>() <= row[limit].get<double>() ? "<=" : "> ", number(row, limit, 1));
}

std::string scenes_table(const json& rows) {
  std::string text =
      fmt::format("{:<8} {:<7} {:<10} {:>6} {:>6}  {:>9} {:<7} {:>9} {:>10} {:>9} {:>7}  {}\n", "scene", "method", "backend",
                  "nodes", "ratio", "ms/step", "limit", "source", "dt [ms]", "ms/frame", "spread", "hash");
  for (const json& r : rows) {
    if (r["part"] != "scenes") continue;
    text += fmt::format("{:<8} {:<7} {:<10} {:>6} {:>6}  {:>9} {:<7} {:>9} {:>10} {:>9} {:>6}%  {}\n", words(r, "scene"),
                        words(r, "method"), words(r, "backend"), r["nodes"].get<std::int64_t>(), number(r, "ratio", 3),
                        number(r, "ms_per_step", 4), against(r, "ms_per_step", "limit_ms"), number(r, "source_ms", 1),
                        number(r, "dt", 3, 1e3), number(r, "ms_per_frame", 2), number(r, "spread", 0, 100), words(r, "hash"));
  }
  return text;
}

std::string scaling_table(const json& rows) {
  std::string text =
      fmt::format("{:<7} {:<10} {:>9} {:>2} {:<7} {:>8} {:<8} {:>10} {:>10} {:>7} {:>7}  {}\n", "method", "backend", "nodes",
                  "w", "cut", "ns/node", "limit", "ms/step", "set-up [s]", "of best", "spread", "hash");
  for (const json& r : rows) {
    if (r["part"] != "scaling") continue;
    text += fmt::format("{:<7} {:<10} {:>9} {:>2} {:<7} {:>8} {:<8} {:>10} {:>10} {:>6}% {:>6}%  {}\n", words(r, "method"),
                        words(r, "backend"), r["nodes"].get<std::int64_t>(), r["width"].get<int>(), words(r, "cut"),
                        number(r, "ns_per_node", 1), against(r, "ns_per_node", "limit_ns"), number(r, "ms_per_step", 3),
                        number(r, "set_up_seconds", 2), number(r, "fraction", 0, 100), number(r, "spread", 0, 100),
                        words(r, "hash"));
  }
  return text;
}

std::string accuracy_table(const json& rows) {
  std::string text = fmt::format("{:<28} {:<7} {:>8} {:>6} {:>9} {:>9} {:>15} {:>8} {:>10} {:>10}\n", "series", "method",
                                 "substeps", "ratio", "ms/step", "error", "near interface", "far", "flsm alone", "speed-up");
  for (const json& r : rows) {
    if (r["part"] != "accuracy") continue;
    const auto percent = [&](const char* key, int digits) {
      const std::string value = number(r, key, digits, 100);
      return value.empty() ? value : value + "%";
    };
    text += fmt::format("{:<28} {:<7} {:>8} {:>6} {:>9} {:>9} {:>15} {:>8} {:>10} {:>10}\n", words(r, "series"),
                        words(r, "method"), r["substeps"].get<int>(), number(r, "ratio", 3), number(r, "ms_per_step", 4),
                        percent("error_operational", 2), percent("error_near_interface", 2), percent("error_far", 2),
                        percent("error_flsm", 2), number(r, "speedup", 2));
  }
  return text;
}

}  // namespace

std::string deformation_table(const json& result) {
  const json& rows = result["rows"];
  std::vector<std::pair<std::string, std::string>> tables;
  if (has_part(rows, "scenes"))
    tables.emplace_back("Published scenes (Hybrid Deformation Model); the limit is per step [ms]", scenes_table(rows));
  if (has_part(rows, "scaling"))
    tables.emplace_back("The liver of more nodes; the limit is per node [ns]", scaling_table(rows));
  if (has_part(rows, "accuracy")) {
    tables.emplace_back(
        "The liver indented: errors of the operational nodes against finite elements alone, at the end of the load",
        accuracy_table(rows));
  }
  return titled(tables);
}

}  // namespace pliant::bench
