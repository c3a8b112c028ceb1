// Orders of convergence and fronts of the rows of `pliant bench accuracy`, and the rows as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/accuracy/parts.h"

namespace pliant::bench {
namespace accuracy {
namespace {

using nlohmann::json;

std::map<std::string, double> floors(const json& problems) {
  std::map<std::string, double> floor;
  for (const json& p : problems) floor[p["name"]] = p["floor"];
  return floor;
}

}  // namespace

void add_order(json& rows, const json& problems) {
  const auto floor = floors(problems);
  std::map<std::string, const json*> coarser;
  for (json& row : rows) {
    if (row["error_l2"].is_null() || !row["failure"].is_null()) continue;
    const std::string series = fmt::format("{}|{}|{}|{}", row["problem"].get<std::string>(), row["method"].get<std::string>(),
                                           row["step"].get<std::string>(), row["backend"].get<std::string>());
    const json* before = coarser[series];
    coarser[series] = &row;
    if (before == nullptr) continue;
    const double error = row["error_l2"], last = (*before)["error_l2"];
    // What is as small as the reference's own error, or as rounding, converges to nothing.
    if (error < 2 * floor.at(row["problem"])) continue;
    row["order"] = std::log(last / error) / std::log((*before)["spacing"].get<double>() / row["spacing"].get<double>());
  }
}

void add_pareto(json& rows, const json& problems) {
  const auto floor = floors(problems);
  std::map<std::string, std::vector<json*>> of;
  for (json& row : rows) {
    row["pareto"] = false;
    if (row["failure"].is_null() && !row["error_l2"].is_null()) of[row["problem"]].push_back(&row);
  }
  for (auto& [problem, points] : of) {
    std::stable_sort(points.begin(), points.end(), [](const json* a, const json* b) {
      return (*a)["ms_per_simulated_second"].get<double>() < (*b)["ms_per_simulated_second"].get<double>();
    });
    double best = 1;  // a body that does not move at all is wrong by 100 % and costs nothing
    for (json* row : points) {
      const double error = std::max((*row)["error_l2"].get<double>(), floor.at(problem));
      (*row)["pareto"] = error < best;
      best = std::min(best, error);
    }
  }
}

}  // namespace accuracy

namespace {
using nlohmann::json;

std::string front(const json& problem, const json& rows) {
  std::vector<const json*> points;
  std::size_t count = 0, failed = 0;
  for (const json& r : rows) {
    if (r["problem"] != problem["name"]) continue;
    ++count;
    failed += r["failure"].is_null() ? 0 : 1;
    if (r["pareto"].get<bool>()) points.push_back(&r);
  }
  std::sort(points.begin(), points.end(), [](const json* a, const json* b) {
    return (*a)["ms_per_simulated_second"].get<double>() < (*b)["ms_per_simulated_second"].get<double>();
  });
  std::string text =
      fmt::format("{}: {}\n  reference {}, good to {:.2g} %; {} points{}; the front:\n", problem["name"].get<std::string>(),
                  problem["title"].get<std::string>(), problem["reference"].get<std::string>(),
                  100 * problem["floor"].get<double>(), count, failed > 0 ? fmt::format(", {} without an answer", failed) : "");
  for (const json* r : points) {
    text += fmt::format("  {:<10} {:>4} cells {:>7} nodes  step {:<5} {:<11} {:>10.3f} ms per s {:>9.4f} s  error {:>8.3g} %\n",
                        (*r)["method"].get<std::string>(), (*r)["resolution"].get<int>(), (*r)["nodes"].get<std::int64_t>(),
                        (*r)["step"].get<std::string>(), (*r)["backend"].get<std::string>(),
                        (*r)["ms_per_simulated_second"].get<double>(), (*r)["seconds"].get<double>(),
                        100 * (*r)["error_l2"].get<double>());
  }
  return text;
}

}  // namespace

std::string accuracy_table(const json& result) {
  std::string text;
  for (const json& problem : result["problems"]) text += front(problem, result["rows"]) + "\n";
  text += "Where each method is on the front of speed (ms per simulated second) against error:\n";
  for (const json& f : result["findings"]) {
    const auto where = f["on_front"].get<std::vector<std::string>>();
    text += fmt::format("  {:<10} {}\n", f["method"].get<std::string>(),
                        where.empty() ? "never: another method is at least as fast and as accurate at every point"
                                      : fmt::format("{}", fmt::join(where, ", ")));
  }
  return text;
}

}  // namespace pliant::bench
