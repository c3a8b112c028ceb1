// The liver of more and more nodes under gravity: time per node, set-up, and bodies with cut links.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "backends/choice/backends.h"
#include "bench/deformation/parts.h"
#include "bench/kernels/machine_limits.h"
#include "model/matching/flsm.h"

namespace pliant::bench {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr double kLimits[] = {45, 50, 60};  // [ns] per node and step at half-width 1, 2, 3
constexpr double kSetUpLimit = 20;          // [s] at 1 000 000 nodes

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void unlink(FlsmBatch& batch, std::int32_t node, int direction) {
  std::int32_t& there = batch.link[node][direction];
  if (there < 0) return;
  batch.link[there][direction ^ 1] = -1;
  there = -1;
}

/// All links that cross the plane x = the middle, or one in a hundred of all links.
void cut_links(FlsmBatch& batch, const std::string& cut) {
  const auto nodes = static_cast<std::int32_t>(batch.slot.size());
  std::int32_t low = batch.index[0][0], high = low;
  for (const auto& at : batch.index) {
    low = std::min(low, at[0]);
    high = std::max(high, at[0]);
  }
  const std::int32_t middle = (low + high) / 2;
  std::mt19937 random(1);
  for (std::int32_t n = 0; n < nodes; ++n) {
    for (int d = 1; d < 6; d += 2) {
      const bool chosen = cut == "plane" ? d == 1 && batch.index[n][0] == middle : random() % 100 == 0;
      if (chosen && batch.link[n][d] < nodes) unlink(batch, n, d);
    }
  }
}

Scene liver(const DeformationRun& run, std::int64_t nodes, ModelType type, int width) {
  Scene scene = run.scene("liver");
  Body& body = scene.bodies[0];
  scene.gravity = {0, -0.5, 0};  // every node moves from the first step on; more would invert the cells at the hold in time
  body.prescribed.clear();       // 20 mm of indentation would turn the small cells of a large lattice inside out
  body.lattice.nodes = nodes;
  body.model.type = type;
  body.model.width = width;
  return scene;
}

std::int64_t program_bytes(const Program& program, std::int64_t real_bytes) {
  std::int64_t bytes = 0;
  for (const Buffer& b : program.buffers) bytes += static_cast<std::int64_t>(b.values()) * (b.is_int() ? 4 : real_bytes);
  return bytes;
}

/// Least time of a step by the machine's limits over `seconds`. Loads other programs into the backend.
double fraction_of_limit(Backend& backend, const Program& program, double seconds) {
  const std::int64_t real_bytes = backend.info().real_bytes;
  double bytes = 0, flops = 0;
  for (const Pass& pass : program.step) {
    bytes += pass.bytes_per_element * static_cast<double>(pass.elements) * static_cast<double>(real_bytes) / 4;
    flops += pass.flops_per_element * static_cast<double>(pass.elements);
  }
  const double bandwidth = triad_bandwidth(backend, program_bytes(program, real_bytes)), rate = fma_rate(backend);
  return std::max(bytes / bandwidth, flops / rate) / seconds;
}

/// One row. `build_seconds` of 0: the model is a changed copy, so its set-up is nobody's.
void measure(const DeformationRun& run, const Scene& scene, std::shared_ptr<const Model> model, const std::string& cut,
             double dt, double build_seconds) {
  const auto start = Clock::now();
  SimulationOptions options;
  options.dt = dt;
  options.stable_step = false;
  Simulation simulation(scene, model, open_backend(run.options.backends[0], nullptr, model->nodes()), options);
  const double set_up = build_seconds + seconds_since(start);
  advance(simulation, model->nodes() > 300'000 ? 8 : run.warm_up() / 4);
  json row = deformation_row("scaling", "liver", simulation);
  const Timing step = time_steps(simulation, run.options.quick);
  add_timing(row, step, dt);
  const int width = scene.bodies[0].model.width;
  row["width"] = width;
  row["cut"] = cut;
  row["ns_per_node"] = step.median * 1e9 / static_cast<double>(model->nodes());
  if (scene.bodies[0].model.type == ModelType::flsm) row["limit_ns"] = kLimits[width - 1];
  if (build_seconds > 0) {
    row["set_up_seconds"] = set_up;
    if (model->nodes() > 900'000) row["limit_set_up_seconds"] = kSetUpLimit;
  }
  row["passes"] = time_each_pass(simulation, run.options.quick);
  row["fraction"] = fraction_of_limit(simulation.backend(), simulation.program(), step.median);
  run.rows.push_back(row);
}

}  // namespace

void measure_scaling(const DeformationRun& run) {
  for (const std::int64_t nodes : run.options.sizes) {
    const auto timed_model = [](const Scene& scene, double& seconds) {
      const auto start = Clock::now();
      auto model = std::make_shared<const Model>(build_model(scene));
      seconds = seconds_since(start);
      return model;
    };
    double seconds = 0, dt = 0;
    {
      const Scene scene = liver(run, nodes, ModelType::hybrid, 2);
      run.show(fmt::format("liver of {} nodes, hybrid", nodes));
      const auto model = timed_model(scene, seconds);
      // The bound of the elements at rest, less what the spring of the interface takes (Simulation::coupled_step).
      dt = 0.9 * model->element_bound * std::sqrt(1 - scene.bodies[0].model.alpha / 4);
      measure(run, scene, model, "none", dt, seconds);
    }
    for (const int width : {1, 2, 3}) {
      const Scene scene = liver(run, nodes, ModelType::flsm, width);
      run.show(fmt::format("liver of {} nodes, w = {}", nodes, width));
      const auto whole = timed_model(scene, seconds);
      measure(run, scene, whole, "none", dt, seconds);
      for (const char* cut : {"plane", "random"}) {
        run.show(fmt::format("liver of {} nodes, w = {}, cut: {}", nodes, width, cut));
        auto model = std::make_shared<Model>(*whole);
        FlsmBatch& batch = model->flsm[0];
        cut_links(batch, cut);
        find_batch_regions(batch);
        weigh(batch, model->mass);
        measure(run, scene, model, cut, dt, 0);
      }
    }
  }
}

}  // namespace pliant::bench
