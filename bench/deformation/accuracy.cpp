// The liver under its local indentation: how far the hybrid's operational region is from a body of finite elements alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "backends/choice/backends.h"
#include "bench/deformation/parts.h"
#include "model/matching/matching_step.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr int kNear = 2;  // layers of nodes behind the interface that count as near

struct Outcome {
  std::vector<Vec3d> u;  // at the end of the load, in the order of the lattice
  double ms_per_step = 0, spread = 0;
  json row;
};

Outcome simulate(const DeformationRun& run, const Scene& scene, std::shared_ptr<const Model> model, double dt, double end,
                 bool timed) {
  SimulationOptions options;
  options.dt = dt;
  options.stable_step = false;
  Simulation simulation(scene, model, open_backend(run.options.backends[0], nullptr, model->nodes()), options);
  advance(simulation, std::llround(end / dt));
  Outcome outcome;
  outcome.row = deformation_row("accuracy", "liver", simulation);
  outcome.u = simulation.displacements(0);
  if (timed) {
    const Timing step = time_steps(simulation, run.options.quick);
    add_timing(outcome.row, step, dt);
    outcome.ms_per_step = outcome.row["ms_per_step"];
  }
  return outcome;
}

/// Layers between each node and the interface, through operational cells; -1 for nodes that shape matching moves, large where
/// no interface is within reach.
std::vector<int> layers_of(const Model& model) {
  const ModelBody& body = model.bodies[0];
  const FlsmBatch& batch = model.flsm[0];
  constexpr int kFar = std::numeric_limits<int>::max();
  std::vector<int> by_slot(static_cast<std::size_t>(model.slots), kFar);
  for (std::int32_t i = 0; i < batch.own + batch.interface; ++i) by_slot[batch.slot[i]] = i < batch.own ? -1 : 0;
  std::vector<int> layer;
  for (const std::int32_t s : body.slot) layer.push_back(by_slot[s]);
  for (int reached = 0; reached < kNear; ++reached) {
    for (const auto& hex : body.hexes) {
      const bool touches = std::any_of(hex.begin(), hex.end(), [&](std::int32_t n) { return layer[n] == reached; });
      const bool operational = std::none_of(hex.begin(), hex.end(), [&](std::int32_t n) { return layer[n] == -1; });
      if (!touches || !operational) continue;
      for (const std::int32_t n : hex) {
        if (layer[n] == kFar) layer[n] = reached + 1;
      }
    }
  }
  return layer;
}

struct Norms {
  double difference = 0, reference = 0;  // squared
  void add(const Vec3d& u, const Vec3d& exact) {
    for (int c = 0; c < 3; ++c) {
      difference += (u[c] - exact[c]) * (u[c] - exact[c]);
      reference += exact[c] * exact[c];
    }
  }
  /// Null where there is no such node.
  [[nodiscard]] json relative() const { return reference > 0 ? json(std::sqrt(difference / reference)) : json(); }
};

/// Relative L2 errors of the operational nodes with `low` <= layer <= `high`.
Norms error_of(const std::vector<Vec3d>& u, const std::vector<Vec3d>& exact, const std::vector<int>& layer, int low, int high) {
  Norms norms;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (layer[n] >= low && layer[n] <= high) norms.add(u[n], exact[n]);
  }
  return norms;
}

std::shared_ptr<const Model> model_of(const Scene& scene) { return std::make_shared<const Model>(build_model(scene)); }

double end_of_load(const Scene& scene) {
  double end = 0;
  for (const Prescribed& p : scene.bodies[0].prescribed) end = std::max(end, p.curve.start + p.curve.duration);
  return end;
}

/// A way to set up the shape matching of the liver.
struct Series {
  const char* name;
  bool matched = false;       ///< "stiffness" asks for the material's Young's modulus; otherwise alpha as in the scene
  int substeps = 1;           ///< 0: automatic; 3 stand at this step only with a small ratio: held goals resonate
  bool poisson_free = false;  ///< material of Poisson ratio 0 and the same modulus, as shape matching behaves
};

constexpr Series kSeries[]{{"alpha of the scene"},
                           {"stiffness matched", true},
                           {"stiffness matched, 2 substeps", true, 2},
                           {"stiffness matched, automatic substeps", true, 0},
                           {"stiffness matched, nu = 0", true, 1, true}};

class SeriesRun {
 public:
  SeriesRun(const DeformationRun& run, const Series& series) : run_(run), series_(series), scene_(run.scene("liver")) {}

  void measure_all() {
    Body& body = scene_.bodies[0];
    Material& material = body.material;
    const double young = material.moduli.young();
    if (series_.poisson_free) material.set_moduli(material.law, {young / 2, 0, young / 3});
    body.model.type = ModelType::tled;
    run_.show(fmt::format("liver indented, finite elements alone ({})", series_.name));
    const auto elements = model_of(scene_);
    // One step for all, the bound at rest with room for the interface and for the strain under the tool.
    dt_ = 0.8 * elements->element_bound * std::sqrt(1 - body.model.alpha / 4);
    end_ = run_.options.quick ? 40 * dt_ : end_of_load(scene_);
    exact_ = simulate(run_, scene_, elements, dt_, end_, true);
    finish(exact_.row);
    if (series_.matched) body.model.young = young;
    body.model.substeps = std::max(series_.substeps, 1);
    body.model.type = ModelType::flsm;
    matching_ = simulate(run_, scene_, model_of(scene_), dt_, end_, false);
    body.model.type = ModelType::hybrid;
    for (const double ratio : run_.options.ratios) measure(ratio);
  }

 private:
  void finish(json row) const {
    row["series"] = series_.name;
    row["substeps"] = scene_.bodies[0].model.substeps;
    row["simulated_seconds"] = end_;
    run_.rows.push_back(std::move(row));
  }

  void measure(double ratio) {
    run_.show(fmt::format("liver indented, hybrid of ratio {} ({})", ratio, series_.name));
    DeformationModel& settings = scene_.bodies[0].model;
    settings.ratio = ratio;
    settings.substeps = series_.substeps;
    settings.extrapolate = false;
    const auto model = model_of(scene_);
    take_substeps(*model, scene_);
    const Outcome hybrid = simulate(run_, scene_, model, dt_, end_, true);
    const std::vector<int> layer = layers_of(*model);
    constexpr int kAll = std::numeric_limits<int>::max();
    const Norms all = error_of(hybrid.u, exact_.u, layer, 0, kAll), near = error_of(hybrid.u, exact_.u, layer, 0, kNear);
    json row = hybrid.row;
    row["error_operational"] = all.relative();
    row["error_near_interface"] = near.relative();
    row["error_far"] = error_of(hybrid.u, exact_.u, layer, kNear + 1, kAll).relative();
    row["near_share"] = all.difference > 0 ? near.difference / all.difference : 0;
    row["error_flsm"] = error_of(matching_.u, exact_.u, layer, 0, kAll).relative();
    row["speedup"] = exact_.ms_per_step / hybrid.ms_per_step;
    const bool conservative = settings.conservative;
    settings.conservative = !conservative;
    const Outcome other = simulate(run_, scene_, model_of(scene_), dt_, end_, false);
    settings.conservative = conservative;
    row["coupling"] = conservative ? "conservative" : "one-sided";
    row["error_other_coupling"] = error_of(other.u, exact_.u, layer, 0, kAll).relative();
    finish(std::move(row));
  }

  const DeformationRun& run_;
  const Series& series_;
  Scene scene_;
  double dt_ = 0, end_ = 0;
  Outcome exact_, matching_;
};

}  // namespace

void measure_accuracy(const DeformationRun& run) {
  for (const Series& series : kSeries) SeriesRun(run, series).measure_all();
}

}  // namespace pliant::bench
