// The rows of `pliant bench cutting` as text.
#include "bench/common/table_cells.h"
#include "bench/cutting/cutting.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

std::string power(const json& row, const char* key) { return fmt::format("{:.1e}", row.at(key).get<double>()); }

std::string counts(const json& row, const char* before, const char* after) {
  return fmt::format("{} -> {}", row.at(before).get<std::int64_t>(), row.at(after).get<std::int64_t>());
}

std::string ratio(const json& row) {
  return fmt::format("{:.4f}", row.at("dt_after").get<double>() / row.at("dt_before").get<double>());
}

std::string costs_table(const json& rows, const char* part) {
  std::string text = fmt::format(
      "{:<22} {:<14} {:<8} {:>5} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>7} {:>16} {:>9} {:>9}\n",
      "scene", "method", "element", "cuts", "ms/cut", "search", "topology", "surface", "model", "upload", "look", "mass",
      "volume", "dt ratio", "closed", "elements", "step", "after");
  for (const json& r : rows) {
    if (r["part"] != part) continue;
    text += fmt::format(
        "{:<22} {:<14} {:<8} {:>5} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>7} {:>16} {:>9} {:>9}\n",
        words(r, "scene"), words(r, "method"), words(r, "element"), r["cuts"].get<std::int64_t>(), number(r, "ms_per_cut", 2),
        number(r, "ms_search", 2), number(r, "ms_topology", 2), number(r, "ms_surface", 2), number(r, "ms_model", 2),
        number(r, "ms_upload", 2), number(r, "ms_step", 2), power(r, "mass_error"), power(r, "volume_error"), ratio(r),
        r["closed"].get<bool>() ? "yes" : "no", counts(r, "elements_before", "elements_after"),
        number(r, "ms_per_step_before", 3), number(r, "ms_per_step_after", 3));
  }
  return text;
}

std::string steps_table(const json& rows) {
  std::string text =
      fmt::format("{:<14} {:<8} {:>7} {:>12} {:>12} {:>12} {:>12} {:>14} {:>9} {:>9} {:>7}\n", "method", "element", "cuts",
                  "least", "1 in 100", "median", "dt [ms]", "Lanczos least", "mass", "volume", "closed");
  for (const json& r : rows) {
    if (r["part"] != "steps") continue;
    const json& q = r["dt_ratio_quantiles"];
    text +=
        fmt::format("{:<14} {:<8} {:>7} {:>12.6f} {:>12.6f} {:>12.6f} {:>12} {:>14} {:>9} {:>9} {:>7}\n", words(r, "method"),
                    words(r, "element"), r["cuts"].get<std::int64_t>(), r["dt_ratio_least"].get<double>(), q[1].get<double>(),
                    q[50].get<double>(), number(r, "dt_before", 4, 1e3), number(r, "stable_ratio_least", 6),
                    power(r, "mass_error"), power(r, "volume_error"), r["closed"].get<bool>() ? "yes" : "no");
  }
  return text;
}

std::string strokes_table(const json& rows) {
  const auto count = [](const json& r, const char* key) {
    return r[key].is_null() ? std::string() : fmt::format("{}", r[key].get<std::int64_t>());
  };
  std::string text = fmt::format("{:<14} {:<8} {:>7} {:>6} {:>5} {:>8} {:>5} {:>7} {:>8} {:>8} {:>9} {:>9} {:>8} {:>9} {:>9}\n",
                                 "method", "element", "strokes", "edits", "open", "inverted", "lost", "new", "mass", "volume",
                                 "momentum", "energy", "pieces", "differing", "dt ratio");
  for (const json& r : rows) {
    if (r["part"] != "strokes") continue;
    text += fmt::format("{:<14} {:<8} {:>7} {:>6} {:>5} {:>8} {:>5} {:>7} {:>8} {:>8} {:>9} {:>9} {:>8} {:>9} {:>9}\n",
                        words(r, "method"), words(r, "element"), count(r, "cuts"), count(r, "edits"), count(r, "open_edits"),
                        count(r, "inverted"), count(r, "lost"), count(r, "elements_new"), power(r, "mass_error"),
                        power(r, "volume_error"), power(r, "momentum_error"), power(r, "energy_gain"), power(r, "piece_error"),
                        fmt::format("{}/{}", r["differing"].get<int>() + r["resumed_differing"].get<int>(),
                                    r["compared"].get<int>() + r["resumed"].get<int>()),
                        ratio(r));
  }
  for (const json& r : rows) {
    for (const json& fault : r.value("faults", json::array()))
      text += fmt::format("{}, {}: {}\n", words(r, "method"), words(r, "element"), fault.get<std::string>());
  }
  return text;
}

}  // namespace

std::string cutting_table(const json& result) {
  const json& rows = result["rows"];
  std::vector<std::pair<std::string, std::string>> tables;
  if (has_part(rows, "scenes"))
    tables.emplace_back("The shipped scenes, per frame that changed elements [ms]", costs_table(rows, "scenes"));
  if (has_part(rows, "methods")) tables.emplace_back("The same cuts by four methods [ms]", costs_table(rows, "methods"));
  if (has_part(rows, "live"))
    tables.emplace_back("The same stroke through the same running body by the methods of blades [ms]",
                        costs_table(rows, "live"));
  if (has_part(rows, "steps"))
    tables.emplace_back("The stable step over random cuts, as a share of that before", steps_table(rows));
  if (has_part(rows, "strokes"))
    tables.emplace_back("Random strokes under load: what edits kept at worst, and what went wrong", strokes_table(rows));
  return titled(tables);
}

}  // namespace pliant::bench
