#include "bench/deformation/deformation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "backends/choice/backends.h"
#include "bench/common/shipped_scenes.h"
#include "bench/deformation/parts.h"
#include "bench/kernels/kernels.h"
#include "pliant/error.h"
#include "program/hash.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

const std::vector<std::string> kScenes{"bunny", "apple", "liver", "kidney"};
const std::vector<std::string> kParts{"scenes", "scaling", "accuracy"};

void require_known(const char* option, std::vector<std::string>& chosen, const std::vector<std::string>& known) {
  if (chosen.empty()) chosen = known;
  for (const std::string& word : chosen) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: got \"{}\", expected {}", option, word, fmt::join(known, ", ")));
    }
  }
}

DeformationOptions completed(DeformationOptions options) {
  require_known("--only", options.only, kScenes);
  require_known("--parts", options.parts, kParts);
  if (options.backends.empty()) options.backends = {"auto"};
  if (options.sizes.empty()) {
    options.sizes = options.quick ? std::vector<std::int64_t>{2000} : std::vector<std::int64_t>{10'000, 100'000};
  }
  if (options.full && options.sizes.back() < 1'000'000) options.sizes.push_back(1'000'000);
  for (const std::int64_t size : options.sizes) {
    if (size < 500 || size > 10'000'000)
      throw Error(ErrorCode::bad_input, fmt::format("--sizes: got {}, expected 500 to 10000000 nodes", size));
  }
  if (options.ratios.empty()) {
    for (int tenths = options.quick ? 5 : 1; tenths <= (options.quick ? 5 : 9); ++tenths)
      options.ratios.push_back(tenths / 10.0);
  }
  for (const double ratio : options.ratios) {
    if (!(ratio > 0 && ratio < 1))
      throw Error(ErrorCode::bad_input, fmt::format("--ratios: got {}, expected numbers between 0 and 1", ratio));
  }
  options.scenes = find_shipped_scenes(options.scenes, "liver_hybrid.json");
  return options;
}

double measurements(const DeformationOptions& o) {
  double count = 0;
  for (const std::string& part : o.parts) {
    if (part == "scenes") count += static_cast<double>(3 * o.only.size() * o.backends.size());
    if (part == "scaling") count += static_cast<double>(10 * o.sizes.size());
    if (part == "accuracy") count += static_cast<double>(o.ratios.size() + 1);
  }
  return count;
}

}  // namespace

Scene DeformationRun::scene(const std::string& name) const { return load_scene(options.scenes / (name + "_hybrid.json")); }

void advance(Simulation& simulation, std::int64_t steps) {
  simulation.advance(steps);
  if (simulation.divergence()) throw Error(ErrorCode::diverged, simulation.divergence()->message());
}

Timing time_steps(Simulation& simulation, bool quick) {
  // The automatic step is estimated anew every 256 steps: batches of as many share its cost alike.
  constexpr std::int64_t kPeriod = 256;
  const auto seconds_for = [&](std::int64_t steps) {
    const auto start = std::chrono::steady_clock::now();
    advance(simulation, steps);
    simulation.backend().finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::int64_t steps = 4;
  if (!quick) {
    const double once = seconds_for(4) / 4;
    const double longest = 0.6;  // [s] per batch
    steps =
        once * kPeriod < longest ? kPeriod : std::clamp(static_cast<std::int64_t>(longest / once), std::int64_t{2}, kPeriod);
    seconds_for(steps);
  }
  std::vector<double> samples;
  for (int b = 0; b < 7; ++b) samples.push_back(seconds_for(steps) / static_cast<double>(steps));
  return summary(samples);
}

json time_each_pass(Simulation& simulation, bool quick) {
  Backend& backend = simulation.backend();
  const std::int32_t steps = quick ? 4 : 64;
  backend.profile(true);
  backend.take_profile();
  simulation.run_steps(0, steps);
  json passes = json::array();
  for (const PassTime& t : backend.take_profile()) {
    passes.push_back({{"kernel", t.kernel},
                      {"label", t.label},
                      {"us_per_launch", t.seconds * 1e6 / static_cast<double>(t.launches)},
                      {"launches_per_step", static_cast<double>(t.launches) / steps}});
  }
  backend.profile(false);
  return passes;
}

double operational_share(const Model& model) {
  double nodes = 0, shared = 0;
  for (const ModelBody& body : model.bodies) {
    nodes += static_cast<double>(body.slot.size());
    shared += static_cast<double>(body.operational_nodes + body.interface_nodes);
  }
  return shared / nodes;
}

json deformation_row(const std::string& part, const std::string& scene, const Simulation& simulation) {
  return {{"part", part},
          {"scene", scene},
          {"method", to_string(simulation.scene().bodies[0].model.type)},
          {"backend", simulation.backend().info().name},
          {"nodes", simulation.model().nodes()},
          {"ratio", operational_share(simulation.model())},
          {"hash", hash_text(simulation.hash())}};
}

void add_timing(json& row, const Timing& step, double dt) {
  row["ms_per_step"] = step.median * 1e3;
  row["spread"] = step.spread;
  row["dt"] = dt;
  row["ms_per_frame"] = step.median * 1e3 * std::ceil(1.0 / 60 / dt - 1e-6);
}

json bench_deformation(const DeformationOptions& asked) {
  const DeformationOptions options = completed(asked);
  json result;
  result["machine"] = machine_and_backends();
  result["rows"] = json::array();
  const double total = measurements(options);
  double begun = 0;
  const DeformationRun run{options, result["rows"], [&](const std::string& what) {
                             if (options.progress) options.progress(begun++ / total, what);
                           }};
  for (const std::string& part : options.parts) {
    if (part == "scenes") measure_scenes(run);
    if (part == "scaling") measure_scaling(run);
    if (part == "accuracy") measure_accuracy(run);
  }
  if (options.progress) options.progress(1, "done");
  return result;
}

}  // namespace pliant::bench
