// Part steps: what random cuts do to the stable step: planes and curved strips, through nodes, edges and faces, cut again and
// across each other.
#include <algorithm>
#include <cmath>
#include <random>

#include "backends/twins/ref_backend.h"
#include "bench/cutting/parts.h"
#include "geometry/vec.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr double kEdge = 0.01;  // [m]
constexpr std::array<int, 3> kCells{4, 3, 3};
constexpr int kLanczosEvery = 25;  // decomposed bodies whose stable step is estimated too

Scene block(ElementKind element) {
  Scene scene;
  scene.name = "block of 4 x 3 x 3 cells";
  Body body;
  body.name = "block";
  body.surface = "block.obj";
  auto box = std::make_shared<TriangleMesh>();
  for (int a = 0; a < 8; ++a) {
    box->vertices.push_back({kEdge * kCells[0] * (a & 1), kEdge * kCells[1] * (a >> 1 & 1), kEdge * kCells[2] * (a >> 2 & 1)});
  }
  box->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  body.surface_in_memory = box;
  body.lattice.spacing = kEdge;
  body.element = element;
  body.material.set_moduli(Law::neo_hookean, Moduli::from_lame(4000, 1000));
  body.pointer = "/bodies/0";
  scene.bodies.push_back(body);
  return scene;
}

class RandomSweep {
 public:
  explicit RandomSweep(unsigned seed) : random_(seed) {}
  [[nodiscard]] int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  std::vector<SweepTriangle> next() {
    if (pick(3) == 0) return strip();
    Vec3d point{}, normal{};
    for (int a = 0; a < 3; ++a) {
      point[a] = kEdge * (pick(2) == 0 ? pick(kCells[a] + 1) : real(0, kCells[a]));
      normal[a] = pick(2) == 0 ? pick(3) - 1 : real(-1, 1);
    }
    if (vec::norm(normal) < 0.1) normal = {1, 0, 0};
    return plane_sweep(point, normal, pick(4) == 0 ? 1.5 * kEdge : 0.2);
  }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::vector<SweepTriangle> strip() {
    std::vector<SweepTriangle> all;
    const auto point = [&](double z) { return Vec3d{kEdge * real(-0.5, 4.5), kEdge * real(-0.5, 3.5), kEdge * z}; };
    BladeSegment blade{point(-1), point(4)};
    for (int k = 2 + pick(6); k > 0; --k) {
      const BladeSegment next{pick(4) == 0 ? blade[0] : point(real(-1, 1)), point(real(2, 4))};
      const auto part = sweep(blade, next);
      all.insert(all.end(), part.begin(), part.end());
      blade = next;
    }
    return all;
  }
  std::mt19937 random_;
};

/// Ratios of steps after cuts to the step before all cuts.
struct Ratios {
  std::vector<double> bound, stable;
};

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

json quantiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  json out = json::array();
  for (std::size_t q = 0; q <= 100; ++q) out.push_back(values[q * (values.size() - 1) / 100]);
  return out;
}

struct Trial {
  std::string method;
  ElementKind element = ElementKind::tet4;
  Scene scene;
  std::shared_ptr<const Model> model;
};

Simulation start(const Trial& trial, std::shared_ptr<const Model> model) {
  Scene scene = trial.scene;
  scene.dt = scene.safety * model->element_bound;
  RefOptions one;
  one.threads = 1;
  one.probe = false;
  return Simulation(scene, std::move(model), make_ref_backend(one), {0, 64, false});
}

BodyFigures cut_virtual_nodes(const Trial& trial, RandomSweep& random, int cuts, double bound, double stable, Ratios& out) {
  Simulation simulation = start(trial, trial.model);
  for (; cuts > 0; --cuts) {
    simulation.cut(random.next());
    out.bound.push_back(simulation.model().element_bound / bound);
    out.stable.push_back(simulation.estimate_stable_dt() / stable);
  }
  return figures_of(simulation.model());
}

BodyFigures cut_mesh(const Trial& trial, RandomSweep& random, int cuts, double bound, double stable, Ratios& out) {
  ElementMesh mesh = plain_mesh(make_body_mesh(trial.scene.bodies[0]));
  for (; cuts > 0; --cuts) {
    const auto sweep = random.next();
    mesh = trial.method == "decomposition" ? decompose_crossed(mesh, sweep).mesh : separate_crossed(mesh, sweep).mesh;
    out.bound.push_back(element_bound(mesh, trial.scene.bodies[0].material) / bound);
    if (out.bound.size() % kLanczosEvery != 0) continue;
    Simulation simulation = start(trial, std::make_shared<const Model>(build_model(trial.scene, {solid_of(mesh)})));
    out.stable.push_back(simulation.estimate_stable_dt() / stable);
  }
  return figures_of(build_model(trial.scene, {solid_of(mesh)}));
}

void measure(const CuttingRun& run, const std::string& method, ElementKind element, double first, double share) {
  Trial trial{method, element, block(element), nullptr};
  trial.model = std::make_shared<const Model>(build_model(trial.scene));
  const BodyFigures before = figures_of(*trial.model);
  const double stable = start(trial, trial.model).estimate_stable_dt();
  RandomSweep random(20240917);
  Ratios ratios;
  bool closed = true;
  double mass = 0, volume = 0;
  BodyFigures worst = before;
  while (static_cast<std::int64_t>(ratios.bound.size()) < run.options.cuts) {
    const auto left = run.options.cuts - static_cast<std::int64_t>(ratios.bound.size());
    const int cuts = static_cast<int>(std::min<std::int64_t>(1 + random.pick(5), left));
    const BodyFigures now =
        (method == "virtual nodes" ? cut_virtual_nodes : cut_mesh)(trial, random, cuts, before.dt, stable, ratios);
    closed = closed && now.closed;
    mass = std::max(mass, std::abs(now.mass / before.mass - 1));
    volume = std::max(volume, std::abs(now.volume / before.volume - 1));
    worst.elements = std::max(worst.elements, now.elements);
    worst.nodes = std::max(worst.nodes, now.nodes);
    run.show_progress(first + share * static_cast<double>(ratios.bound.size()) / static_cast<double>(run.options.cuts),
                      method + ", " + to_string(element));
  }
  worst.dt = before.dt * least(ratios.bound);
  worst.closed = closed;
  json row = cutting_row("steps", trial.scene.name, method, to_string(element), run.options.cuts, before, worst, {});
  row["mass_error"] = mass;
  row["volume_error"] = volume;
  row["dt_ratio_least"] = least(ratios.bound);
  row["dt_ratio_quantiles"] = quantiles(ratios.bound);
  row["stable_before"] = stable;
  if (!ratios.stable.empty()) {
    row["stable_ratio_least"] = least(ratios.stable);
    row["stable_ratio_quantiles"] = quantiles(ratios.stable);
  }
  run.rows.push_back(row);
}

}  // namespace

void measure_stable_steps(const CuttingRun& run) {
  measure(run, "virtual nodes", ElementKind::hex8, 0, 0.35);
  measure(run, "virtual nodes", ElementKind::tet4, 0.35, 0.35);
  measure(run, "decomposition", ElementKind::tet4, 0.7, 0.2);
  measure(run, "separation", ElementKind::tet4, 0.9, 0.1);
}

}  // namespace pliant::bench
