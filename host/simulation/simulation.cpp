#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "layout.h"
#include "model/ballast.h"
#include "pliant/error.h"
#include "program/hash.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/calm.h"
#include "simulation/coupling.h"
#include "simulation/relaxation.h"
#include "simulation/remarks.h"

namespace pliant {

/// An increment of a step that calls for a look at its length, as a share of the shortest element.
constexpr double kFastIncrement = 0.1;
/// Largest increment of an element's nodes against each other, as a share of its edge. Steps below half the first take less:
/// the limit is then that of the first step, a velocity of about half that of sound.
constexpr double kFastest = 0.25;
/// An element whose nodes move so many edges against each other in one step, twice what a batch begins with at most, has burst,
/// even if its numbers are finite still.
constexpr double kBurst = 0.5;

std::string Divergence::message() const {
  return fmt::format(
      "the simulation diverged in step {} (t = {:.6g} s): {} {} of body '{}' is {}not finite; dt = {:.6g} s, "
      "stable step "
      "{:.6g} s ({:.3g} times); the state of step {} was kept",
      step, time, node ? "node" : "element", element, body, node ? "" : "inverted or ", dt, stable_dt,
      stable_dt > 0 ? dt / stable_dt : 0.0, last_good_step);
}

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
  Program program = build_program(*model, {scene_.integrator, settings_.batch_steps});
  Program surface = pliant::surface_program(model->surface, program);
  loaded_.load(std::move(model), std::move(program), std::move(surface));
}

void Simulation::start(std::shared_ptr<const Model> model, const SimulationOptions& options) {
  settings_.batch_steps = options.batch_steps;
  load(std::move(model));
  for (const Curve& curve : loaded_.model().curves) {
    settings_.curves_end = std::max(settings_.curves_end, curve.end());
  }
  step_.start(options.dt > 0 ? options.dt : scene_.dt, options.stable_step);
  edits_.start();
  contact_.start();
  if (backend().info().real_bytes == 4) {  // the double oracle needs neither floor nor grid
    // Squares and cubes of what is left stay normal numbers.
    settings_.increment_floor = 1e-12 * loaded_.model().shortest;
    settings_.displacement_grid = std::ldexp(1.0, 22 + std::ilogb(settings_.increment_floor));
  }
  upload_coupling(run_);
  set_initial_increment();
}

/// w_0 = h v_0 - h^2/2 a_0, so that the first step is that of a parabola through the initial position and velocity.
void Simulation::set_initial_increment() {
  const Model& m = loaded_.model();
  const std::vector<double> force = run_.forces_now();
  std::vector<double> w(4 * static_cast<std::size_t>(m.slots));
  const Vec3d gravity = scene_.gravity_at(time());
  const double sign = scene_.integrator == Integrator::textbook ? -1 : 1;  // the textbook form keeps u_(-1) instead
  for (std::size_t s = 0; s < m.mass.size(); ++s) {
    const double h = substeps_of(m, s) * state_.clock.dt;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!loaded_.free()[3 * s + c]) continue;
      const double a = force[4 * s + c] / m.mass[s] + gravity[c] - m.damping[s] * m.velocity[s][c];
      w[4 * s + c] = sign * (h * m.velocity[s][c] - 0.5 * h * h * a);
    }
    w[4 * s + 3] = run_.decay(m, s);
  }
  loaded_.write_w(w);
}

std::int64_t Simulation::advance(std::int64_t steps) {
  const std::int64_t first = step();
  while (step() - first < steps && !divergence_ && !at_equilibrium()) {
    const std::int32_t n = next_batch(steps - (step() - first));
    begin_batch(n);
    backend().run(program().step, 0, n, step());
    end_batch(n);
  }
  return step() - first;
}

void Simulation::begin_batch(std::int32_t steps) {
  const bool on_grid = step_.on_grid(step());
  if (on_grid) edits_.update();
  step_.adapt_when_due();
  if (on_grid) drift_.follow();
  if (!state_.kept || (on_grid && worth_keeping())) keep_state();
  run_.upload_params();
  run_.upload_curves(steps);
  contact_.begin_batch(steps);
}

void Simulation::end_batch(std::int32_t steps) {
  const std::int64_t start = step();
  state_.clock.step += steps;
  look_for_fault(start);
  if (step() == start + steps) contact_.end_batch(steps);
  if (!divergence_ && scene_.relaxation.enabled && run_.begins_after(step(), kRelaxEvery)) relax(run_);
  ballast_.nodes = static_cast<std::int64_t>(state_.ballast.size());
  ballast_.mass = 0;
  for (const NodeInertia& b : state_.ballast) ballast_.mass += b.inertia;
  ballast_.most = std::max(ballast_.most, ballast_.mass);
}

/// With a step that the user gave a run may burst long before a number ends: what flies apart is no state to go back to.
bool Simulation::worth_keeping() {
  if (settings_.automatic || scene_.integrator != Integrator::increment) return true;
  backend().run(program().status, 0, 1);
  return loaded_.largest_increment() <= kBurst * model().shortest;
}

void Simulation::keep_state() {
  loaded_.keep_state();
  contact_.keep();
  state_.kept = KeptState{state_.clock, state_.relaxation.damping};
}

void Simulation::look_for_fault(std::int64_t batch_start) {
  // The steps looked at the states they started from; the last state is looked at here, before it can pass for a good one.
  backend().run(program().force, static_cast<std::int32_t>(step() - batch_start), 1);
  backend().run(program().status, 0, 1);
  const std::vector<std::int32_t> summary = loaded_.faults();
  std::int32_t fault = 0, element = 0, lowest = std::numeric_limits<std::int32_t>::max();
  std::int64_t inverted = 0;
  for (std::size_t i = 0; i < summary.size(); i += PLIANT_FAULT_SUMMARY) {
    if (summary[i + 2] > 0) {
      inverted += summary[i + 2];
      lowest = std::min(lowest, summary[i + 3]);
    }
    if (summary[i] == 0) continue;
    if (fault == 0 || summary[i] < fault || (summary[i] == fault && summary[i + 1] < element)) {
      fault = summary[i];
      element = summary[i + 1];
    }
  }
  inversions_.last = 0;
  if (fault == 0) {
    if (inverted > 0) count_inversions(batch_start, inverted, lowest);
    // Judged by the state alone, and only where states are kept: a run may be cut into pieces anywhere else.
    if (!settings_.automatic || !state_.kept || !step_.on_grid(step())) return;
    const double largest = loaded_.largest_increment() / model().shortest;
    double fastest = 0;
    if (largest > kFastIncrement * fast_share()) {
      const Calmed calmed = calm(run_, kFastest * fast_share());
      inversions_.calmed += calmed.elements;
      fastest = calmed.fastest;
    }
    if (fastest > kBurst && step_.can_retry() && step_.above_floor() && retry_from_kept()) return;
    // Pieces that fly as they are deform no faster for it.
    if (fastest <= kFastIncrement && (inverted == 0 || !inverted_now())) return;
    const std::optional<StepControl::Outgrown> outgrown = step_.outgrown();
    if (!outgrown) return;
    return_to_kept();
    if (edits_.fewer_substeps()) {
      loaded_.clear_faults();
    } else {
      step_.shorten(*outgrown);
    }
    inversions_.calmed += calm(run_, kFastest * fast_share() * state_.limit.dt_backoff).elements;
    return;
  }
  if (retry_from_kept()) return;
  const FaultLocation found = find_fault(model(), element);
  divergence_ = Divergence{batch_start + fault,
                           state_.clock.time_at(batch_start + fault - 1),
                           found.body >= 0 ? model().bodies[static_cast<std::size_t>(found.body)].name : "?",
                           found.element,
                           found.node,
                           dt(),
                           stable_dt(),
                           step()};
}

/// The batch that led here is not to be trusted: the kept state again, and fewer substeps or a smaller step if there are any.
bool Simulation::retry_from_kept() {
  return_to_kept();
  if (edits_.fewer_substeps()) {
    loaded_.clear_faults();
  } else if (!step_.retry_smaller()) {
    return false;
  }
  inversions_.calmed += calm(run_, kFastest * fast_share() * state_.limit.dt_backoff).elements;
  return true;
}

double Simulation::fast_share() const { return std::min(1.0, 2 * dt() / state_.limit.dt_ceiling); }

void Simulation::return_to_kept() {
  loaded_.return_to_kept_state();
  contact_.return_to_kept();
  state_.clock = state_.kept->clock;
  state_.relaxation.damping = state_.kept->damping;
}

bool Simulation::inverted_now() {
  backend().run(program().force, 0, 1);
  backend().run(program().status, 0, 1);
  const std::vector<std::int32_t> summary = loaded_.faults();
  loaded_.clear_faults();
  for (std::size_t i = 0; i < summary.size(); i += PLIANT_FAULT_SUMMARY) {
    if (summary[i + 2] > 0) return true;
  }
  return false;
}

void Simulation::count_inversions(std::int64_t batch_start, std::int64_t count, std::int32_t element) {
  if (inversions_.batches == 0) {
    const FaultLocation found = find_fault(model(), element);
    inversions_.first_step = batch_start + 1;
    inversions_.first_time = state_.clock.time_at(batch_start);
    inversions_.body = found.body >= 0 ? model().bodies[static_cast<std::size_t>(found.body)].name : "?";
    inversions_.element = found.element;
  }
  ++inversions_.batches;
  inversions_.last = count;
  inversions_.most = std::max(inversions_.most, count);
  loaded_.clear_faults();
}

std::vector<Vec3d> Simulation::velocities(std::size_t body) const {
  const std::vector<double> w = loaded_.w();
  if (scene_.integrator == Integrator::increment) return run_.velocities(w, body);
  std::vector<double> u = loaded_.u();  // of which w is the one before
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= w[i];
  return loaded_.pick(u, body, 1 / dt());
}

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

std::vector<std::string> Simulation::remarks() const { return remarks_on(model(), scene_, dt()); }

std::uint64_t Simulation::hash() const {
  std::uint64_t h = 0;
  for (const char* name : {"node_u", "node_w"}) {
    const auto bytes = backend().read_bytes(program().find(name));
    h = hash_bytes(bytes.data(), bytes.size(), h);
  }
  return h;
}

std::uint64_t Simulation::model_hash() const {
  return hash_of(parts_of(scene_, settings_, model(), program(), loaded_.surface()));
}

void Simulation::restore(const Snapshot& snapshot) {
  const RunState& next = snapshot.state;
  const std::string real = backend().info().real_bytes == 8 ? "double" : "float";
  if (snapshot.real_type != real) {
    throw Error(ErrorCode::bad_input, fmt::format("a state in {} cannot resume on the backend {}, which computes in {}",
                                                  snapshot.real_type, backend().info().name, real));
  }
  // Everything is made and checked aside.
  std::unique_ptr<EditedBodies> bodies = edits_.bodies_at(next);
  std::shared_ptr<const Model> model = loaded_.shared_model();
  const Scene scene = edits_.scene_at(next);
  if (bodies != nullptr) model = std::make_shared<const Model>(build_model(scene, bodies->solids()));
  check_ballast(next, *model);
  if (!next.ballast.empty() || !model->ballast.empty()) {
    const auto heavier = std::make_shared<Model>(*model);
    set_ballast(scene, *heavier, next.ballast);
    model = heavier;
  }
  Program program = build_program(*model, {scene_.integrator, settings_.batch_steps});
  Program surface = pliant::surface_program(model->surface, program);
  const std::string other = differing(snapshot.made_of, parts_of(scene_, settings_, *model, program, surface));
  if (!other.empty()) {
    throw Error(ErrorCode::bad_input, fmt::format("a state goes on in the scene and with the step that it was taken from; "
                                                  "not the same: {}",
                                                  other));
  }
  check_state(next, *model, scene_);
  check_buffers(snapshot, program);
  const Snapshot before = this->snapshot();
  const std::shared_ptr<const Model> old_model = loaded_.shared_model();
  try {
    loaded_.load(std::move(model), std::move(program), std::move(surface));
    write_buffers(snapshot, loaded_);
    state_ = next;
    run_.place_surface();
    upload_coupling(run_);  // the automatic beta belongs to the step
    if (!state_.forces.empty()) loads_.upload();
  } catch (...) {
    load(old_model);
    write_buffers(before, loaded_);
    state_ = before.state;
    run_.place_surface();
    upload_coupling(run_);
    if (!state_.forces.empty()) loads_.upload();
    throw;
  }
  edits_.take_up(std::move(bodies));
  divergence_.reset();
}

}  // namespace pliant
