// The table of execution times of the Hybrid Deformation Model (docs/references.md): hybrid as shipped, and one kind only.
#include <fmt/format.h>

#include <algorithm>

#include "backends/choice/backends.h"
#include "bench/deformation/parts.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr double kLimit = 0.2;  // [ms] per step of each scene

struct Case {
  const char* scene;
  double source_ms;  // published total cost of a step, on the machine of its authors
};
constexpr Case kCases[] = {{"bunny", 13.5}, {"apple", 16.2}, {"liver", 20.4}, {"kidney", 24.6}};

/// One row; returns the step that the simulation had come to.
double measure(const DeformationRun& run, const Case& of, const Scene& scene, const std::string& asked, double dt) {
  run.show(fmt::format("{} {} {}", of.scene, to_string(scene.bodies[0].model.type), asked));
  auto model = std::make_shared<const Model>(build_model(scene));
  SimulationOptions options;
  options.dt = dt;
  Simulation simulation(scene, model, open_backend(asked, nullptr, model->nodes()), options);
  advance(simulation, run.warm_up());
  json row = deformation_row("scenes", of.scene, simulation);
  const double reached = simulation.dt();
  add_timing(row, time_steps(simulation, run.options.quick), reached);
  row["asked"] = asked;
  row["source_ms"] = of.source_ms;
  row["limit_ms"] = kLimit;
  row["passes"] = time_each_pass(simulation, run.options.quick);
  run.rows.push_back(row);
  return reached;
}

}  // namespace

void measure_scenes(const DeformationRun& run) {
  for (const Case& of : kCases) {
    const auto& only = run.options.only;
    if (std::find(only.begin(), only.end(), of.scene) == only.end()) continue;
    for (const std::string& backend : run.options.backends) {
      Scene scene = run.scene(of.scene);
      const double dt = measure(run, of, scene, backend, 0);
      scene.bodies[0].model.type = ModelType::tled;
      measure(run, of, scene, backend, 0);
      // Shape matching is stable with any step; with the hybrid's it does the same work per frame.
      scene.bodies[0].model.type = ModelType::flsm;
      measure(run, of, scene, backend, dt);
    }
  }
}

}  // namespace pliant::bench
