#include "bench/contact/contact.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/contact/parts.h"
#include "bench/kernels/kernels.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace contact {

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"rest", "Does tissue rest under a tool that stands still, and how deep is the tool in it?", measure_rest},
      {"tissue", "Does tissue rest on tissue?", measure_tissue},
      {"strokes", "Which strokes are not felt?", measure_strokes},
      {"figures", "Are the figures of docs/contact.md still right?", measure_figures},
      {"costs", "What is the step with contact over the step without?", measure_costs},
  };
  return all;
}

}  // namespace contact

namespace {

using nlohmann::json;

ContactOptions checked(const ContactOptions& asked) {
  ContactOptions o = asked;
  for (const auto& [count, option] : {std::pair{o.tools, "--tools"}, {o.strokes, "--strokes"}}) {
    if (count < 1 || count > 10'000'000)
      throw Error(ErrorCode::bad_input, fmt::format("{}: got {}, expected 1 to 10000000", option, count));
  }
  for (const std::int64_t size : o.sizes) {
    if (size < 1000 || size > 10'000'000)
      throw Error(ErrorCode::bad_input, fmt::format("--sizes: got {}, expected 1000 to 10000000 nodes", size));
  }
  if (o.quick) {
    o.tools = std::min<std::int64_t>(o.tools, 6);
    o.strokes = std::min<std::int64_t>(o.strokes, 24);
    o.sizes = {3000};
  }
  return o;
}

}  // namespace

json bench_contact(const ContactOptions& asked) {
  const ContactOptions options = checked(asked);
  json result{
      {"machine", machine_facts()},
      {"quick", options.quick},
      {"backend", options.backend},
  };
  measure_parts<contact::PartRun>(contact::parts(), options, result, [](const contact::PartRun&) {});
  return result;
}

std::string contact_table(const json& result) { return rows_table(result); }

}  // namespace pliant::bench
