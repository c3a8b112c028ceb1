#include "bench/haptics/haptics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bench/haptics/parts.h"
#include "bench/kernels/kernels.h"
#include "geometry/stopwatch.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace haptics {

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"strokes", "Does the buffer model feel what the full model feels?", measure_strokes},
      {"others", "What do simpler models feel on the same strokes?", measure_others},
      {"edits", "Is a cut felt?", measure_edits},
      {"passivity", "Is the hand safe?", measure_passivity},
      {"times", "Are the ticks in time, beside a simulation that cuts?", measure_times},
  };
  return all;
}

void PartRun::trace(const std::string& scene, const std::string& model, const ForceTrace& trace) {
  constexpr std::size_t kMost = 4000;
  nlohmann::json force = nlohmann::json::array();
  for (std::size_t k = 0; k < std::min(kMost, trace.wrench.size()); ++k) {
    const Vec3d& f = trace.wrench[k].force;
    force.push_back({std::round(1e6 * f[0]) / 1e6, std::round(1e6 * f[1]) / 1e6, std::round(1e6 * f[2]) / 1e6});
  }
  traces_.push_back({{"scene", scene}, {"model", model}, {"period", trace.period}, {"force", force}});
}

}  // namespace haptics

namespace {

using haptics::Part;
using haptics::PartRun;
using nlohmann::json;

std::vector<const Part*> chosen(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Part& part : haptics::parts()) known.emplace_back(part.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::bad_input, fmt::format("--parts: got \"{}\", expected {}", name, fmt::join(known, ", ")));
  }
  std::vector<const Part*> out;
  for (const Part& part : haptics::parts()) {
    if (names.empty() || std::find(names.begin(), names.end(), part.name) != names.end()) out.push_back(&part);
  }
  return out;
}

}  // namespace

json bench_haptics(const HapticsOptions& asked) {
  HapticsOptions options = asked;
  if (!(options.seconds >= 1) || options.seconds > 3600)
    throw Error(ErrorCode::bad_input, fmt::format("--seconds: got {}, expected 1 to 3600", options.seconds));
  if (options.quick) options.seconds = std::min(options.seconds, 2.0);
  const std::vector<const Part*> wanted = chosen(options.parts);
  json result{{"machine", machine_facts()}, {"quick", options.quick}, {"seconds", options.seconds},
              {"parts", json::array()},     {"rows", json::array()},  {"traces", json::array()}};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Stopwatch clock;
    PartRun run(wanted[i]->name, options, [&](double done, const std::string& what) {
      if (options.progress) options.progress((static_cast<double>(i) + done) / static_cast<double>(wanted.size()), what);
    });
    wanted[i]->measure(run);
    result["parts"].push_back({{"name", wanted[i]->name}, {"question", wanted[i]->question}, {"seconds", clock.seconds()}});
    for (const json& row : run.rows()) result["rows"].push_back(row);
    for (const json& trace : run.traces()) result["traces"].push_back(trace);
  }
  result["summary"] = summary_of(result["rows"]);
  if (options.progress) options.progress(1, "done");
  return result;
}

std::string haptics_table(const json& result) { return rows_table(result); }

}  // namespace pliant::bench
