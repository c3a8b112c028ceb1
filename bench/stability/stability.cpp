#include "bench/stability/stability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "bench/kernels/kernels.h"
#include "bench/stability/sweeps.h"
#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace stability {

using nlohmann::json;

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> all{
      {"step", "How long may a step be, by element, aspect ratio and Poisson's ratio?", sweep_step},
      {"share", "How soon does the engine stop when the step is too long?", sweep_share},
      {"poisson", "Up to which Poisson's ratio is static equilibrium found?", sweep_poisson},
      {"contrast", "What do two materials in one body do to the step?", sweep_contrast},
      {"bodies", "What do two bodies of unlike mass and size do to the step?", sweep_bodies},
      {"sliver", "What do cells with little material do to the step?", sweep_sliver},
      {"stretch", "How far can a body be stretched and pressed?", sweep_stretch},
      {"inversion", "From which starts does a body return to its shape?", sweep_inversion},
      {"load", "Which loads and motions may be switched on at once?", sweep_load},
      {"hourglass", "How much of the bending energy of hex8 is hourglass energy?", sweep_hourglass},
      {"rest", "Does a body at rest drift?", sweep_rest},
      {"matching", "How stiff is shape matching, how far does it overshoot?", sweep_matching},
      {"alpha", "Up to which alpha is shape matching stable?", sweep_alpha},
      {"beta", "Up to which stiffness is the interface of a hybrid stable?", sweep_beta},
      {"subcycling", "How long may a step be with several steps of elements per step of shape matching?", sweep_subcycling},
  };
  return all;
}

void SweepRun::add(const std::string& method, json parameters, const Finding& f, const json& more) {
  const auto number = [](const Number& x) { return x ? json(*x) : json(); };
  json row{{"sweep", name_},
           {"method", method},
           {"parameters", std::move(parameters)},
           {"quantity", f.quantity},
           {"predicted", number(f.predicted)},
           {"measured", number(f.measured)},
           {"reached", f.reached},
           {"outcome", f.outcome},
           {"diagnosis", f.diagnosis},
           {"exit_code", f.exit_code}};
  row.update(more);
  rows_.push_back(std::move(row));
}

void SweepRun::add_step_limit(Method method, json parameters, const Specimen& specimen) {
  const double estimate = estimated_step(specimen);
  const Limit limit = measured_step(specimen, estimate);
  Finding f{"dt [s]", estimate, limit.value, limit.reached, "", "", 0};
  Specimen heavy = specimen;
  heavy.scene.gravity = {0, -9.81, 0};
  const Ending past = run_past(heavy, 1.02 * limit.value, 4000);
  f.outcome = past.words();
  f.diagnosis = past.message;
  f.exit_code = past.exit_code();
  add(method, std::move(parameters), f,
      {{"element_bound", specimen.model->element_bound}, {"finite", past.finite}, {"latency", past.latency}});
}

}  // namespace stability

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using stability::Sweep;
using stability::SweepRun;

constexpr int kFormat = 1;  ///< of kept sweeps

std::vector<const Sweep*> chosen(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Sweep& sweep : stability::sweeps()) known.emplace_back(sweep.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::bad_input, fmt::format("--sweeps: got \"{}\", expected {}", name, fmt::join(known, ", ")));
  }
  std::vector<const Sweep*> out;
  for (const Sweep& sweep : stability::sweeps()) {
    if (names.empty() || std::find(names.begin(), names.end(), sweep.name) != names.end()) out.push_back(&sweep);
  }
  return out;
}

/// A finished sweep of an earlier call, if it was made with the same options; null otherwise.
json kept(const fs::path& file, bool quick) {
  std::ifstream in(file);
  const json found = json::parse(in, nullptr, false);
  const bool same = found.is_object() && found.value("format", 0) == kFormat && found.value("quick", !quick) == quick &&
                    found.contains("seconds") && found.contains("rows");
  return same ? found : json();
}

}  // namespace

json bench_stability(const StabilityOptions& options) {
  using Clock = std::chrono::steady_clock;
  const std::vector<const Sweep*> wanted = chosen(options.sweeps);
  json result{{"machine", machine_facts()}, {"quick", options.quick}, {"sweeps", json::array()}, {"rows", json::array()}};
  if (!options.keep.empty()) fs::create_directories(options.keep);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Sweep& sweep = *wanted[i];
    const fs::path file = options.keep / fmt::format("{}.json", sweep.name);
    json done = options.keep.empty() ? json() : kept(file, options.quick);
    if (done.is_null()) {
      const auto start = Clock::now();
      SweepRun run(sweep.name, options.quick, [&](const std::string& what) {
        if (options.progress) options.progress(static_cast<double>(i) / static_cast<double>(wanted.size()), what);
      });
      sweep.measure(run);
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      done = {{"format", kFormat}, {"quick", options.quick}, {"seconds", seconds}, {"rows", run.rows()}};
      if (!options.keep.empty()) write_file(file, done.dump() + "\n");
    }
    result["sweeps"].push_back({{"name", sweep.name}, {"question", sweep.question}, {"seconds", done["seconds"]}});
    for (json& row : done["rows"]) result["rows"].push_back(std::move(row));
  }
  if (options.progress) options.progress(1, "done");
  return result;
}

}  // namespace pliant::bench
