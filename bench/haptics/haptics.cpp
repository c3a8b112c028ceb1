#include "bench/haptics/haptics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/haptics/parts.h"
#include "bench/kernels/kernels.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace haptics {

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"strokes", "Does the buffer model feel what the full model feels?", measure_strokes},
      {"others", "What do simpler models feel on the same strokes?", measure_others},
      {"edits", "Is a cut felt?", measure_edits},
      {"instruments", "Do a scalpel and forceps feel what they do in the full model?", measure_instruments},
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

using nlohmann::json;

json bench_haptics(const HapticsOptions& asked) {
  HapticsOptions options = asked;
  if (!(options.seconds >= 1) || options.seconds > 3600)
    throw Error(ErrorCode::bad_input, fmt::format("--seconds: got {}, expected 1 to 3600", options.seconds));
  if (options.quick) options.seconds = std::min(options.seconds, 2.0);
  json result{{"machine", machine_facts()}, {"quick", options.quick}, {"seconds", options.seconds}, {"traces", json::array()}};
  measure_parts<haptics::PartRun>(haptics::parts(), options, result, [&](const haptics::PartRun& run) {
    for (const json& trace : run.traces()) result["traces"].push_back(trace);
  });
  return result;
}

std::string haptics_table(const json& result) { return rows_table(result); }

}  // namespace pliant::bench
