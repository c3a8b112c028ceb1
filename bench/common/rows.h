// Rows of a benchmark that tests: a value, what is expected, the error and its bound.
#pragma once
#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/stopwatch.h"

namespace pliant::bench {

class Rows {
 public:
  Rows(std::string part, std::function<void(double, const std::string&)> show)
      : part_(std::move(part)), show_(std::move(show)) {}

  /// What is being measured; `done`: share of the part.
  void show(double done, const std::string& what) const { show_(done, part_ + ": " + what); }
  /// `scene` says which of several rows of a test this is, with all that it was drawn with.
  void at_most(const std::string& test, const std::string& scene, double value, double bound);
  /// The error is relative.
  void close_to(const std::string& test, const std::string& scene, double value, double expected, double bound);
  /// The error is what `value` is less than `expected`, as a share of it.
  void at_least(const std::string& test, const std::string& scene, double value, double expected, double bound);
  /// A value that nothing is asked of.
  void told(const std::string& test, const std::string& scene, double value);
  /// A scene that could not be measured, and why.
  void failed(const std::string& test, const std::string& scene, const std::string& why);
  [[nodiscard]] const nlohmann::json& rows() const { return rows_; }

 private:
  void add(const std::string& test, const std::string& scene, nlohmann::json value, nlohmann::json expected,
           nlohmann::json error, nlohmann::json bound, const std::string& message = "");

  std::string part_;
  std::function<void(double, const std::string&)> show_;
  nlohmann::json rows_ = nlohmann::json::array();
};

/// {"rows": number, "asked": with a bound, "ok": that keep it}.
nlohmann::json summary_of(const nlohmann::json& rows);

/// Throws Error (bad_input) for a name that is not `known`.
void check_parts(const std::vector<std::string>& known, const std::vector<std::string>& names);

/// The parts of `all` with these names, all if there are none. Throws Error (bad_input) for another name.
template <class Part>
std::vector<const Part*> chosen_parts(const std::vector<Part>& all, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Part& part : all) known.emplace_back(part.name);
  check_parts(known, names);
  std::vector<const Part*> out;
  for (const Part& part : all) {
    if (names.empty() || std::find(names.begin(), names.end(), part.name) != names.end()) out.push_back(&part);
  }
  return out;
}

/// Measures the chosen parts into "parts", "rows" and "summary" of `result`. `after` receives each part's run.
template <class PartRun, class Part, class Options, class After>
void measure_parts(const std::vector<Part>& all, const Options& options, nlohmann::json& result, const After& after) {
  const std::vector<const Part*> wanted = chosen_parts(all, options.parts);
  result["parts"] = result["rows"] = nlohmann::json::array();
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Stopwatch clock;
    PartRun run(wanted[i]->name, options, [&](double done, const std::string& what) {
      if (options.progress) options.progress((static_cast<double>(i) + done) / static_cast<double>(wanted.size()), what);
    });
    wanted[i]->measure(run);
    result["parts"].push_back({{"name", wanted[i]->name}, {"question", wanted[i]->question}, {"seconds", clock.seconds()}});
    for (const nlohmann::json& row : run.rows()) result["rows"].push_back(row);
    after(run);
  }
  result["summary"] = summary_of(result["rows"]);
  if (options.progress) options.progress(1, "done");
}

/// {"parts": [{"name", "question"}], "rows", "summary"} for people: a line per test, and one per row that is not as it should
/// be.
std::string rows_table(const nlohmann::json& result);

}  // namespace pliant::bench
