// Part scenes: the shipped scenes with blades, frame by frame, as an application would drive them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "bench/cutting/parts.h"
#include "bench/deformation/parts.h"
#include "scene/blade_face.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr double kFrame = 1.0 / 60;  // [s]

void move_blades(Simulation& simulation, const std::vector<Blade>& blades, double time, std::vector<CutTimes>& changed,
                 std::vector<double>& frames) {
  std::vector<BladePose> begin, places;
  for (const Blade& blade : blades) {
    const double first = blade.begins(), last = blade.ends();
    if (time < first || time >= last + kFrame) continue;
    if (time < first + kFrame) begin.push_back({blade.name, blade.at(first)});
    places.push_back({blade.name, blade.at(std::min(time, last))});
  }
  simulation.move_blades(begin);  // puts them there
  const CutReport report = simulation.move_blades(places);
  frames.push_back(1e3 * report.seconds());
  if (report.changed)
    changed.push_back({report.search, report.topology, report.surface, report.model, report.upload, report.step});
}

void measure(const CuttingRun& run, const std::string& name) {
  run.show(name);
  Scene scene = load_scene(run.options.scenes / (name + ".json"));
  const std::vector<Blade> blades = std::move(scene.blades);
  drop_blades(scene);
  scene.cuttable = true;
  scene.name = name;
  double end = 0;
  for (const Blade& blade : blades) end = std::max(end, blade.ends());
  if (run.options.quick) {  // smaller bodies, and a step that needs no estimate
    for (Body& body : scene.bodies) {
      if (body.lattice.nodes > 0) body.lattice.nodes = std::min<std::int64_t>(body.lattice.nodes, 500);
      body.lattice.spacing *= 2;
    }
  }
  const auto model = std::make_shared<const Model>(build_model(scene));
  if (run.options.quick) scene.dt = scene.safety * model->element_bound;
  const BodyFigures before = figures_of(*model);
  const auto start = [&] {
    return Simulation(scene, model, open_backend(run.options.backend, nullptr, model->nodes()), {0, 64, false});
  };
  const double step_before = [&] {
    Simulation uncut = start();
    return ms_per_step(uncut, run.options.quick);
  }();
  Simulation simulation = start();
  simulation.prepare_cuts();
  std::vector<CutTimes> changed;
  std::vector<double> frames;
  bool closed = true;
  double worst_volume = 0, least_dt = before.dt;
  for (int frame = 0; frame * kFrame <= end + kFrame; ++frame) {
    const double time = frame * kFrame, left = time - simulation.time();
    const auto steps = static_cast<std::int64_t>(std::ceil(left / simulation.dt() - 1e-6));
    if (steps > 0) advance(simulation, run.options.quick ? std::min<std::int64_t>(steps, 2) : steps);
    const std::size_t edits = changed.size();
    move_blades(simulation, blades, time, changed, frames);
    if (changed.size() == edits) continue;
    const BodyFigures now = figures_of(simulation.model());
    closed = closed && now.closed;
    worst_volume = std::max(worst_volume, std::abs(now.volume / before.volume - 1));
    least_dt = std::min(least_dt, now.dt);
    run.show_progress(time / end, name);
  }
  BodyFigures after = figures_of(simulation.model());
  after.closed = closed;
  after.dt = least_dt;
  json row = cutting_row("scenes", name, "virtual nodes", to_string(scene.bodies[0].element),
                         static_cast<std::int64_t>(changed.size()), before, after, changed);
  row["volume_error"] = worst_volume;
  row["ms_per_step_before"] = step_before;
  row["ms_per_step_after"] = ms_per_step(simulation, run.options.quick);
  row["backend"] = simulation.backend().info().name;
  std::sort(frames.begin(), frames.end());
  row["ms_worst_frame"] = frames.back();
  row["ms_per_frame"] = row["ms_per_step_after"].get<double>() * std::ceil(kFrame / simulation.dt());
  run.rows.push_back(row);
}

}  // namespace

void measure_cut_scenes(const CuttingRun& run) {
  for (const char* name : {"cut_liver", "cut_bunny", "cut_block_progressive", "slice_many"}) {
    if (run.options.quick && std::string(name) == "cut_bunny") continue;  // its file of 70 000 triangles takes seconds to fill
    measure(run, name);
  }
}

}  // namespace pliant::bench
