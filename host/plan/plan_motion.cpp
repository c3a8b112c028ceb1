#include "plan/plan_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "backends/interface/timing.h"
#include "geometry/stopwatch.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "simulation/simulation.h"

namespace pliant::planning {
namespace {

constexpr std::int64_t kLeastTimed = 32;  ///< steps of a batch whose time counts
constexpr double kReferenceShare = 0.4;   ///< of the time that is given
constexpr std::int64_t kFinerThanLeast = 4;

/// Displacements and forces between two steps, where a time lies between them.
struct Moment {
  double time = 0;
  std::vector<Vec3d> u, force;
};

Moment now_of(Simulation& simulation) {
  Moment m{simulation.time(), simulation.surface_positions(), {}};
  const std::vector<Vec3d>& rest = simulation.model().surface.rest;
  for (std::size_t v = 0; v < m.u.size(); ++v) m.u[v] = vec::sub(m.u[v], rest[v]);
  for (const ToolHistory& tool : simulation.report().tools) m.force.push_back(tool.now.force);
  return m;
}

void append_between(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, double share, std::vector<Vec3d>& out) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    out.push_back(a.size() == b.size() ? vec::add(a[i], vec::mul(vec::sub(b[i], a[i]), share)) : b[i]);
  }
}

/// Steps a simulation to given times, and notes how long its batches take.
class Recorder {
 public:
  Recorder(Simulation& simulation, double most) : simulation_(simulation), most_(most) {}

  /// Returns false when the time is up or the simulation diverges.
  bool go_to(double until, Recording& out) {
    while (simulation_.time() + 2 * simulation_.dt() < until) {
      const auto left = static_cast<std::int64_t>((until - simulation_.time()) / simulation_.dt()) - 1;
      if (!advance(std::clamp<std::int64_t>(left, 1, 256))) return false;
    }
    Moment before = now_of(simulation_);
    while (simulation_.time() < until) {
      before = now_of(simulation_);
      if (!advance(1)) return false;
    }
    const Moment after = now_of(simulation_);
    const double share = after.time > before.time ? (until - before.time) / (after.time - before.time) : 1;
    append_between(before.u, after.u, share, out.u);
    append_between(before.force, after.force, share, out.force);
    return true;
  }
  [[nodiscard]] double ms_per_step() const { return times_.empty() ? 0 : 1e3 * summary(times_).median; }
  [[nodiscard]] double seconds() const { return clock_.seconds(); }

 private:
  bool advance(std::int64_t steps) {
    const Stopwatch batch;
    const std::int64_t done = simulation_.advance(steps);
    if (done >= std::min(kLeastTimed, steps) && done > 0) {
      if (done >= kLeastTimed || times_.empty()) times_.push_back(batch.seconds() / static_cast<double>(done));
    }
    return !simulation_.divergence() && clock_.seconds() < most_;
  }

  Simulation& simulation_;
  double most_;
  Stopwatch clock_;
  std::vector<double> times_;  ///< of a step [s]
};

std::vector<Vec3d> mean_of(const std::vector<Recording>& runs, std::vector<Vec3d> Recording::*what) {
  std::vector<Vec3d> mean((runs[0].*what).size());
  for (const Recording& run : runs) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] = vec::add(mean[i], vec::mul((run.*what)[i], 1.0 / static_cast<double>(runs.size())));
    }
  }
  return mean;
}

/// Three lattices whose spacings are no multiples of each other. Throws Error where one does not reach the end.
Reference reference_of(const Scene& scene, const Size& size, std::int64_t nodes, double course, double most,
                       const PlanOptions& options) {
  std::vector<Recording> runs;
  for (const double share : {1.0, 0.8, 0.64}) {
    const auto wanted = std::llround(share * static_cast<double>(nodes));
    if (options.detail) options.detail(fmt::format("about {} nodes", wanted));
    runs.push_back(record(reference_scene(scene, size, wanted), course, most, options));
    if (runs.back().remark.empty()) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: the reference of {} nodes cannot be found: {}; expected a scene that runs, or a coarser "
                            "reference (--reference)",
                            scene.file.string(), runs.back().nodes, runs.back().remark));
  }
  Reference out;
  out.u = mean_of(runs, &Recording::u);
  out.force = mean_of(runs, &Recording::force);
  out.norm = norm_of(out.u);
  if (!(out.norm > 0)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: nothing moves this body in its first {:.3g} s, so there is no error to plan for",
                            scene.file.string(), course));
  }
  double square = 0;
  for (const Recording& run : runs) square += std::pow(norm_of(difference(run.u, out.u)), 2);
  out.uncertainty = std::sqrt(square / static_cast<double>(runs.size() - 1)) / out.norm;
  out.nodes = runs[0].nodes;
  return out;
}

}  // namespace

double course_of(const Scene& scene) {
  double end = end_of_curves(scene);
  for (const ContactTool& tool : scene.tools) {
    if (!tool.path.empty()) end = std::max(end, tool.path.back()[0]);
  }
  return end > 0 ? std::min(end, scene.duration) : scene.duration;
}

Recording record(const Scene& scene, double course, double most, const PlanOptions& options) {
  Recording out;
  const auto model = std::make_shared<const Model>(build_model(scene));
  out.nodes = model->nodes();
  out.spacing = model->bodies[0].spacing;
  Simulation simulation(scene, model, open_backend(options.backend, nullptr, out.nodes));
  simulation.advance(1);  // compiles kernels, which is no part of a step's time
  Recorder recorder(simulation, most);
  bool good = !simulation.divergence();
  for (int k = 1; k <= kSamples && good; ++k) good = recorder.go_to(course * k / kSamples, out);
  out.dt = simulation.dt();
  out.ms_per_step = recorder.ms_per_step();
  out.seconds = recorder.seconds();
  if (simulation.divergence()) {
    out.remark = simulation.divergence()->message();
  } else if (!good) {
    out.remark = fmt::format("not at its end after {:.3g} s, at {:.3g} of {:.3g} s", out.seconds, simulation.time(), course);
  }
  return out;
}

Reference make_moving_reference(const Scene& scene, const Size& size, const PlanOptions& options, double& course) {
  const Stopwatch start;
  const double most = kReferenceShare * options.seconds;
  // A coarse run says what a fine one takes: nodes, and steps that shorten with the spacing.
  const Recording coarse = record(reference_scene(scene, size, options.least_nodes), course, most, options);
  if (coarse.dt > 0 && coarse.ms_per_step > 0) {
    const auto runs = [&](double nodes) {  // of three lattices [s]
      return 2.2e-3 * course / coarse.dt * coarse.ms_per_step * std::pow(nodes / static_cast<double>(coarse.nodes), 4.0 / 3);
    };
    const auto fewest = static_cast<double>(kFinerThanLeast * options.least_nodes);
    course *= std::min(1.0, 0.5 * most / runs(std::min(fewest, static_cast<double>(options.reference_nodes))));
  }
  Reference out;
  std::int64_t nodes = std::min(options.reference_nodes, kFinerThanLeast * options.least_nodes);
  for (;; nodes *= 2) {
    const Stopwatch began;
    try {
      out = reference_of(scene, size, nodes, course, std::max(1.0, 2 * most), options);
    } catch (const Error&) {
      if (out.nodes == 0) throw;
      break;
    }
    // Twice the nodes take about two and a half times as long.
    if (out.uncertainty <= options.tolerance / 2 && out.nodes >= options.most_nodes) break;
    if (start.seconds() + 2.6 * began.seconds() > most) break;
  }
  out.seconds = start.seconds();
  return out;
}

void measure_motion(Trial& trial, const Reference& reference, double course, double most, const PlanOptions& options) {
  const Recording run = record(trial.scene, course, most, options);
  trial.nodes = run.nodes;
  trial.spacing = run.spacing;
  trial.dt = run.dt;
  trial.ms_per_step = run.ms_per_step;
  trial.ms_per_frame = run.ms_per_step * options.frame / run.dt;
  trial.remark = run.remark;
  if (!run.remark.empty()) return;
  const std::vector<Vec3d> miss = difference(run.u, reference.u);
  trial.error = norm_of(miss) / reference.norm;
  trial.error_max = largest(miss) / largest(reference.u);
  const double force = norm_of(reference.force);
  if (force > 0) trial.error_force = norm_of(difference(run.force, reference.force)) / force;
}

}  // namespace pliant::planning
