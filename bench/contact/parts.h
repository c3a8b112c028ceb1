// The parts of `pliant bench contact`, and how they report.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/contact/contact.h"

namespace pliant::bench::contact {

class PartRun {
 public:
  PartRun(std::string name, const ContactOptions& asked, std::function<void(double, const std::string&)> show)
      : options(asked), name_(std::move(name)), show_(std::move(show)) {}

  /// What is being measured; `done`: share of the part.
  void show(double done, const std::string& what) const { show_(done, name_ + ": " + what); }
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

  const ContactOptions& options;

 private:
  void add(const std::string& test, const std::string& scene, nlohmann::json value, nlohmann::json expected,
           nlohmann::json error, nlohmann::json bound, const std::string& message = "");

  std::string name_;
  std::function<void(double, const std::string&)> show_;
  nlohmann::json rows_ = nlohmann::json::array();
};

struct Part {
  const char* name;
  const char* question;
  void (*measure)(PartRun&);
};
/// In the order of the report.
const std::vector<Part>& parts();

void measure_rest(PartRun& run);     ///< tools pressed into tissue and held
void measure_tissue(PartRun& run);   ///< tissue pressed on tissue
void measure_strokes(PartRun& run);  ///< tools that go across and into tissue
void measure_figures(PartRun& run);  ///< closed forms and what is conserved
void measure_costs(PartRun& run);    ///< the step with contact over that without

}  // namespace pliant::bench::contact
