// One point: the engine brings the body to rest, then its steps are timed.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "backends/choice/backends.h"
#include "bench/accuracy/parts.h"
#include "pliant/error.h"
#include "program/hash.h"

namespace pliant::bench::accuracy {
namespace {

using nlohmann::json;

constexpr double kAtRest = 1e-5;    ///< what may still be missing, relative to the largest displacement
constexpr double kNoise = 2e-7;     ///< changes below this are rounding in float
constexpr double kRestless = 2e-3;  ///< changes above this at the end are no answer

/// The body's motion towards rest. Mass damping is critical for the slowest mode, so the rest comes in a known time.
class Settling {
 public:
  Settling(const Case& c, const Built& built) : field_(built.mesh), places_(field_.locate(c.problem->samples)) {
    SimulationOptions options;
    options.dt = built.scene.dt;
    simulation_ =
        std::make_unique<Simulation>(built.scene, built.model, open_backend(c.backend, nullptr, built.model->nodes()), options);
    omega_ = built.scene.bodies[0].material.damping / 2;
    loaded_ = load_curve(*c.problem).duration;
  }

  /// Until what is missing, by the rate of change, is little; at most sixty times the slowest mode's time.
  bool run() {
    const double look = 0.5 / omega_;
    double last_change = 0;
    int quiet = 0;
    std::vector<Vec3d> last = samples();
    for (double end = look; end < loaded_ + 60 / omega_; end += look) {
      go_to(end);
      if (simulation_->divergence()) return false;
      u_ = samples();
      const double change = change_ = errors_of(last, u_).max;
      const double rate = last_change > 0 ? change / last_change : 1;
      const double missing = rate < 0.99 ? change * rate / (1 - rate) : change / kNoise;
      const bool still = change < kNoise || (missing < kAtRest && change < 10 * kAtRest);
      quiet = end > loaded_ && still ? quiet + 1 : 0;
      if (quiet == 2) return true;
      last = u_;
      last_change = change;
    }
    return false;
  }

  [[nodiscard]] Simulation& simulation() { return *simulation_; }
  [[nodiscard]] const std::vector<Vec3d>& u() const { return u_; }
  /// Relative, in the last look.
  [[nodiscard]] double change() const { return change_; }

 private:
  void go_to(double end) {
    while (simulation_->time() < end * (1 - 1e-12) && !simulation_->divergence()) {
      const double left = (end - simulation_->time()) / simulation_->dt();
      simulation_->advance(std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(left - 1e-6))));
    }
  }
  [[nodiscard]] std::vector<Vec3d> samples() const {
    const std::vector<Vec3d> nodes = simulation_->displacements(0);
    std::vector<Vec3d> u;
    for (const statics::Place& place : places_) u.push_back(field_.value(place, nodes));
    return u;
  }

  statics::Field field_;
  std::vector<statics::Place> places_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<Vec3d> u_;
  double omega_ = 0, loaded_ = 0, change_ = 0;
};

/// Whole steps at the state of rest, in batches that hold the automatic step's estimates as often as a long run does.
Timing time_steps(Simulation& simulation, bool quick) {
  constexpr std::int64_t kPeriod = 256;
  const auto seconds_for = [&](std::int64_t steps) {
    const auto start = std::chrono::steady_clock::now();
    simulation.advance(steps);
    simulation.backend().finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const double once = seconds_for(16) / 16, longest = quick ? 0.02 : 0.05;  // [s] per batch
  std::int64_t steps = static_cast<std::int64_t>(longest / once);
  steps = steps >= kPeriod ? kPeriod : std::max<std::int64_t>(steps, 4);
  std::vector<double> samples;
  for (int b = 0; b < (quick ? 3 : 7); ++b) samples.push_back(seconds_for(steps) / static_cast<double>(steps));
  return summary(samples);
}

void add_times(json& row, const Timing& step, double dt, std::int64_t steps, std::int64_t nodes) {
  row["seconds"] = step.median * static_cast<double>(steps);
  row["ms_per_simulated_second"] = step.median * 1e3 / dt;
  row["ns_per_node_step"] = step.median * 1e9 / static_cast<double>(nodes);
  row["spread"] = step.spread;
}

}  // namespace

json measure(const Case& c, const Reference& reference, const std::filesystem::path& scenes, bool quick) {
  const Problem& p = *c.problem;
  json row{{"problem", p.name},
           {"method", c.method->name},
           {"refine", c.refine},
           {"step", c.step},
           {"backend", c.backend},
           {"precision", c.backend == "cpu:double" ? "double" : "float"},
           {"reference", reference.text},
           {"reference_error", reference.error},
           {"settled", false}};
  for (const char* key : {"nodes", "spacing", "resolution", "dt", "steps", "seconds", "ms_per_simulated_second",
                          "ns_per_node_step", "spread", "change", "error_l2", "error_max", "order", "failure"}) {
    row[key] = nullptr;
  }
  row["pareto"] = false;
  try {
    const Built built = build(c, scenes);
    row["nodes"] = built.model->nodes();
    row["spacing"] = built.spacing;
    row["resolution"] = std::llround(p.characteristic / built.spacing);
    if (c.method->type == ModelType::hybrid) row["substeps"] = built.scene.bodies[0].model.substeps;
    Settling settling(c, built);
    row["settled"] = settling.run();
    Simulation& simulation = settling.simulation();
    row["dt"] = simulation.dt();
    row["steps"] = simulation.step();
    if (simulation.divergence()) throw Error(ErrorCode::diverged, simulation.divergence()->message());
    row["hash"] = hash_text(simulation.hash());
    const Errors errors = errors_of(settling.u(), reference.u);
    row["error_l2"] = errors.l2;
    row["error_max"] = errors.max;
    row["change"] = settling.change();
    if (!row["settled"].get<bool>() && settling.change() > kRestless) {
      row["failure"] = fmt::format("did not come to rest: still moves by {:.2g} % per look", 100 * settling.change());
    }
    const std::int64_t steps = simulation.step();
    const Timing step = time_steps(simulation, quick);
    add_times(row, step, row["dt"].get<double>(), steps, built.model->nodes());
  } catch (const Error& error) {
    row["failure"] = error.what();
  }
  return row;
}

}  // namespace pliant::bench::accuracy
