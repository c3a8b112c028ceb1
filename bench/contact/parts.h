// The parts of `pliant bench contact`, and how they report.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/common/rows.h"
#include "bench/contact/contact.h"

namespace pliant::bench::contact {

class PartRun : public Rows {
 public:
  PartRun(std::string name, const ContactOptions& asked, std::function<void(double, const std::string&)> show)
      : Rows(std::move(name), std::move(show)), options(asked) {}
  const ContactOptions& options;
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
