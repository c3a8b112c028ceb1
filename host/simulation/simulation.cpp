#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/matching/matching_step.h"
#include "model/nodes/ballast.h"
#include "pliant/error.h"
#include "program/hash.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/edits/node_edits.h"
#include "simulation/measure/remarks.h"
#include "simulation/step/coupling.h"
#include "simulation/step/initial_motion.h"
#include "simulation/step/relaxation.h"

namespace pliant {

Simulation::Simulation(Scene scene, std::unique_ptr<Backend> backend, const SimulationOptions& options)
    : scene_(std::move(scene)), loaded_(std::move(backend)) {
  start(std::make_shared<const Model>(build_model(scene_)), options);
}

Simulation::Simulation(Scene scene, std::shared_ptr<const Model> model, std::unique_ptr<Backend> backend,
                       const SimulationOptions& options)
    : scene_(std::move(scene)), loaded_(std::move(backend)) {
  start(std::move(model), options);
}

void Simulation::load(std::shared_ptr<const Model> model) {
  Program program = build_program(*model, run_.program_options());
  Program surface = pliant::surface_program(model->surface, program);
  loaded_.load(std::move(model), std::move(program), std::move(surface));
}

void Simulation::start(std::shared_ptr<const Model> model, const SimulationOptions& options) {
  settings_.batch_steps = options.batch_steps;
  take_substeps(*model, scene_);
  parameters_.start();
  press_.start(*model);
  load(std::move(model));
  for (const Curve& curve : loaded_.model().curves) {
    settings_.curves_end = std::max(settings_.curves_end, curve.end());
  }
  for (const ContactTool& tool : scene_.tools) {
    if (scene_.relaxation.enabled && !tool.path.empty())
      settings_.curves_end = std::max(settings_.curves_end, tool.path.back()[0]);
  }
  for (const SceneChange& change : scene_.changes) settings_.curves_end = std::max(settings_.curves_end, change.time);
  step_.start(options.dt > 0 ? options.dt : scene_.dt, options.stable_step);
  edits_.share(options.like);
  edits_.start();
  contact_.start();
  if (backend().info().real_bytes == 4) {  // the double reference needs neither floor nor grid
    // Keeps squares and cubes of the remaining values normal numbers.
    settings_.increment_floor = 1e-12 * loaded_.model().shortest;
    settings_.displacement_grid = std::ldexp(1.0, 22 + std::ilogb(settings_.increment_floor));
  }
  upload_coupling(run_);
  if (!loaded_.model().displacement.empty()) start_goals(run_);
  set_initial_motion(run_);
}

std::int64_t Simulation::advance(std::int64_t steps) {
  const std::int64_t first = step();
  while (step() - first < steps && !divergence_ && !at_equilibrium()) {
    const std::int32_t n = next_batch(steps - (step() - first));
    begin_batch(n);
    run_steps(0, n);
    end_batch(n);
  }
  return step() - first;
}

void Simulation::run_steps(std::int32_t first, std::int32_t count) {
  for (std::int32_t k = first; k < first + count;) {
    const std::int32_t n = contact_.before_step(k, first + count - k);
    backend().run(program().step, k, n, step());
    k += n;
  }
}

void Simulation::begin_batch(std::int32_t steps) {
  const bool on_grid = step_.on_grid(step());
  if (on_grid) {
    parameters_.update();
    edits_.update();
  }
  step_.adapt_when_due();
  if (on_grid) drift_.follow();
  press_.begin_batch(steps);
  recovery_.keep(on_grid);
  run_.upload_params();
  run_.upload_curves(steps);
  contact_.begin_batch(steps);
}

void Simulation::end_batch(std::int32_t steps) {
  const std::int64_t start = step();
  state_.clock.step += steps;
  divergence_ = recovery_.look(start);
  if (step() == start + steps) contact_.end_batch(steps);
  press_.end_batch(step() == start + steps ? steps : 0);
  if (!divergence_ && scene_.relaxation.enabled && run_.begins_after(step(), kRelaxEvery)) relax(run_);
  BallastReport& ballast = reports_.now.ballast;
  ballast = {static_cast<std::int64_t>(state_.ballast.size()), 0, ballast.most};
  for (const NodeInertia& b : state_.ballast) ballast.mass += b.inertia;
  ballast.most = std::max(ballast.most, ballast.mass);
  recovery_.shorten();
}

std::vector<Vec3d> Simulation::velocities(std::size_t body) const { return run_.velocities(run_.increments(), body); }

std::vector<Vec3d> Simulation::surface_positions() {
  const Program& surface = loaded_.surface();
  if (surface.step.empty()) return {};
  backend().run(surface.step, 0, 1);
  const std::vector<double> x = backend().read_reals(loaded_.surface_x());
  std::vector<Vec3d> out(model().surface.rest.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = {x[4 * v], x[4 * v + 1], x[4 * v + 2]};
  return out;
}

std::size_t Simulation::surface_bytes() const {
  if (loaded_.surface().step.empty()) return 0;
  const auto vertices = static_cast<std::size_t>(loaded_.surface().step.front().count);
  return 4 * vertices * static_cast<std::size_t>(backend().info().real_bytes);
}

void Simulation::read_surface_into(void* out) {
  if (loaded_.surface().step.empty()) return;
  backend().run(loaded_.surface().step, 0, 1);
  backend().read_into(loaded_.surface_x(), out);
}

CutReport Simulation::move_blade(const std::string& blade, const BladeSegment& segment) {
  const BladePose pose{blade, segment};
  return move_blades(std::span(&pose, 1));
}

void Simulation::set_nodes(std::size_t body, const std::vector<Vec3d>& displacements, const std::vector<Vec3d>& velocities) {
  pliant::set_nodes(run_, body, displacements, velocities);
  loaded_.note_change();
  state_.kept.reset();
  state_.look.tools = state_.look.tissue = -1;
  const double damping = state_.relaxation.damping;
  state_.relaxation = {};  // it compares forces and motions with those of the state before
  state_.relaxation.damping = damping;
  reports_.now.energy.least.reset();  // the host's work
  if (run_.phase() == 0) step_.adapt_after_move();
}

std::vector<std::string> Simulation::remarks() const { return remarks_on(model(), scene_, dt()); }

std::vector<std::uint8_t> Simulation::motion() const {
  std::vector<std::uint8_t> all = backend().read_bytes(program().find("node_u"));
  const std::vector<std::uint8_t> increments = backend().read_bytes(program().find("node_w"));
  all.insert(all.end(), increments.begin(), increments.end());
  return all;
}

std::uint64_t Simulation::hash() const {
  const std::vector<std::uint8_t> bytes = motion();
  return hash_bytes(bytes.data(), bytes.size());
}

std::uint64_t Simulation::model_hash() const {
  return hash_of(parts_of(scene_, settings_, model(), program(), loaded_.surface()));
}

void Simulation::restore(const Snapshot& snapshot) {
  edits_.end_building();
  const RunState& next = snapshot.state;
  const std::string real = backend().info().real_bytes == 8 ? "double" : "float";
  if (snapshot.real_type != real) {
    throw Error(ErrorCode::bad_input, fmt::format("a state in {} cannot resume on the backend {}, which computes in {}",
                                                  snapshot.real_type, backend().info().name, real));
  }
  // Build and check everything before changing this simulation. What builds it sees the scene with the state's parameters.
  Scene present = std::exchange(scene_, parameters_.scene_of(next));
  try {
    take_over(snapshot);
  } catch (...) {
    scene_ = std::move(present);
    throw;
  }
}

void Simulation::take_over(const Snapshot& snapshot) {
  const RunState& next = snapshot.state;
  check_tool_changes(scene_, next.tools);
  std::unique_ptr<EditedBodies> bodies = edits_.bodies_at(next);
  std::shared_ptr<const Model> model = loaded_.shared_model();
  const Scene scene = edits_.scene_at(next);
  if (bodies != nullptr) {
    model = std::make_shared<const Model>(build_model(scene, bodies->solids()));
    if (!next.tools.given.empty()) model = model_with_tools(scene, *model, scene.tools, scene.tools, next.tools.given);
  } else if (scene.tools != contact_.tools() || !next.tools.given.empty() || !state_.tools.given.empty()) {
    model = model_with_tools(scene_, *model, contact_.tools(), scene.tools, next.tools.given);
  }
  check_ballast(next, *model);
  if (!next.ballast.empty() || !model->ballast.empty()) {
    const auto heavier = std::make_shared<Model>(*model);
    set_ballast(scene, *heavier, next.ballast);
    model = heavier;
  }
  Program program = build_program(*model, run_.program_options());
  Program surface = pliant::surface_program(model->surface, program);
  const std::string other = differing(snapshot.made_of, parts_of(scene_, settings_, *model, program, surface));
  if (!other.empty()) {
    throw Error(ErrorCode::bad_input, fmt::format("a state goes on in the scene and with the step that it was taken from; "
                                                  "not the same: {}",
                                                  other));
  }
  check_state(next, *model, scene_);
  check_report(snapshot.reports, next, scene);
  check_buffers(snapshot, program);
  const Snapshot before = this->snapshot();
  const std::shared_ptr<const Model> old_model = loaded_.shared_model();
  try {
    loaded_.load(std::move(model), std::move(program), std::move(surface));
    write_buffers(snapshot, loaded_);
    state_ = next;
    run_.place_surface();
    upload_coupling(run_);  // an automatic beta depends on the step
    if (!state_.forces.empty()) loads_.upload();
    contact_.follow();
    reports_ = snapshot.reports;
  } catch (...) {
    load(old_model);
    write_buffers(before, loaded_);
    state_ = before.state;
    reports_ = before.reports;
    run_.place_surface();
    upload_coupling(run_);
    if (!state_.forces.empty()) loads_.upload();
    throw;
  }
  edits_.take_up(std::move(bodies));
  divergence_.reset();
}

}  // namespace pliant
