// Part live: the same stroke through the same running body with each method of a scene's blades.
#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "bench/cutting/parts.h"
#include "geometry/vec.h"
#include "simulation/edits/blade_fronts.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr int kMoves = 24;

/// A blade goes in the plane through `middle` across x, leaning by `lean`, along y from -reach to reach.
struct Stroke {
  Vec3d middle{};
  double lean = 0, reach = 0;
  [[nodiscard]] BladeSegment at(double way) const {
    const double y = reach * (2 * way - 1), x = middle[0] + lean * y;
    return {Vec3d{x, middle[1] + y, middle[2] - reach}, Vec3d{x, middle[1] + y, middle[2] + reach}};
  }
  [[nodiscard]] double distance(const Vec3d& p) const {
    return std::abs(p[0] - middle[0] - lean * (p[1] - middle[1])) / std::hypot(1, lean);
  }
};

/// Mean distance of the vertices of the cut from the stroke [m].
double cut_distance(const ModelSurface& surface, const Stroke& stroke) {
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.triangle_cut[t] == 0) continue;
    for (const std::int32_t v : surface.triangles[t]) {
      sum += stroke.distance(surface.rest[static_cast<std::size_t>(v)]);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

void measure(const CuttingRun& run, Scene scene, const Stroke& stroke, BladeMethod method) {
  Blade far;  // gives the scene its method; the stroke is a program's
  far.name = "far";
  far.method = method;
  far.path = {{0, 9, 9, 8, 9, 9, 9}, {1, 9, 9.1, 8, 9, 9.1, 9}};
  scene.blades = {far};
  Body& body = scene.bodies[0];
  // The same tetrahedra for all.
  body.plain = method != BladeMethod::virtual_nodes || element_info(body.element).corners == 4;
  const auto model = std::make_shared<const Model>(build_model(scene));
  if (method != BladeMethod::decomposition) scene.dt = scene.safety * model->element_bound;  // there it has to fall
  const BodyFigures before = figures_of(*model);
  Simulation simulation(scene, model, open_backend(run.options.backend, nullptr, model->nodes()), {0, 64, false});
  const double step_before = ms_per_step(simulation, run.options.quick);
  std::vector<CutTimes> times;
  bool closed = true;
  double mass = 0, volume = 0, least_dt = before.dt;
  for (int k = 0; k <= kMoves; ++k) {
    simulation.advance(simulation.next_batch(16));
    const BladePose pose{"scalpel", stroke.at(static_cast<double>(k) / kMoves)};
    const CutReport report = simulation.move_blades(std::span(&pose, 1));
    if (!report.changed) continue;
    times.push_back({report.search, report.topology, report.surface, report.model, report.upload, report.step});
    const BodyFigures now = figures_of(simulation.model());
    closed = closed && now.closed;
    mass = std::max(mass, std::abs(now.mass / before.mass - 1));
    volume = std::max(volume, std::abs(now.volume / before.volume - 1));
    least_dt = std::min(least_dt, now.dt);
  }
  BodyFigures after = figures_of(simulation.model());
  after.closed = closed;
  after.dt = least_dt;
  json row = cutting_row("live", scene.name, method_name(method), to_string(body.element),
                         static_cast<std::int64_t>(times.size()), before, after, times);
  row["mass_error"] = mass;
  row["volume_error"] = volume;
  row["distance"] = cut_distance(simulation.model().surface, stroke) / typical_edge(*model);
  row["ms_per_step_before"] = step_before;
  row["ms_per_step_after"] = ms_per_step(simulation, run.options.quick);
  row["backend"] = simulation.backend().info().name;
  run.rows.push_back(row);
}

}  // namespace

void measure_live_methods(const CuttingRun& run) {
  for (const char* name : {"cut_block_progressive", "cut_liver"}) {
    for (const ElementKind element : {ElementKind::tet4, ElementKind::hex8}) {
      Scene scene = load_scene(run.options.scenes / (std::string(name) + ".json"));
      scene.name = name;
      Body& body = scene.bodies[0];
      body.element = element;
      body.prescribed.clear();
      if (run.options.quick) {
        if (body.lattice.nodes > 0) body.lattice.nodes = 500;
        body.lattice.spacing *= 2;
      }
      const BladeSegment middle = scene.blades[0].at(0.5 * (scene.blades[0].begins() + scene.blades[0].ends()));
      const Stroke stroke{vec::mul(vec::add(middle[0], middle[1]), 0.5), 0.15, 0.2};
      for (const BladeMethod method :
           {BladeMethod::virtual_nodes, BladeMethod::separation, BladeMethod::decomposition, BladeMethod::removal}) {
        if (method == BladeMethod::decomposition && element_info(element).corners != 4) continue;
        run.show(scene.name + ", " + to_string(element));
        measure(run, scene, stroke, method);
      }
    }
  }
}

}  // namespace pliant::bench
