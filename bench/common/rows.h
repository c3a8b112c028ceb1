// Rows of a benchmark that tests: a value, what is expected, the error and its bound.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

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

/// {"parts": [{"name", "question"}], "rows", "summary"} for people: a line per test, and one per row that is not as it should
/// be.
std::string rows_table(const nlohmann::json& result);

}  // namespace pliant::bench
