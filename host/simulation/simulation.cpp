#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "edits/tear_state.h"
#include "pliant/error.h"
#include "program/hash.h"

namespace pliant {
namespace {

/// An automatic step is looked at again every few hundred steps, and sooner after the start, when loads
/// come on.
constexpr std::int64_t kAdaptEvery = 256;
constexpr std::int64_t kFirstAdapts[] = {64, 128};
constexpr int kAdaptIterations = 20;
/// A diverged batch is tried again with a smaller automatic step until that is this share of what the estimate allows.
constexpr double kLeastCaution = 0.1;
constexpr std::int64_t kRelaxEvery = 32;

}  // namespace

std::string Divergence::message() const {
  return fmt::format(
      "the simulation diverged in step {} (t = {:.6g} s): {} {} of body '{}' is {}not finite; dt = {:.6g} s, "
      "stable step "
      "{:.6g} s ({:.3g} times); the state of step {} was kept",
      step, time, node ? "node" : "element", element, body, node ? "" : "inverted or ", dt, stable_dt,
      stable_dt > 0 ? dt / stable_dt : 0.0, last_good_step);
}

Simulation::Simulation(Scene scene, std::unique_ptr<Backend> backend, const SimulationOptions& options)
    : scene_(std::move(scene)), model_(std::make_shared<const Model>(build_model(scene_))), backend_(std::move(backend)) {
  start(options);
}

Simulation::Simulation(Scene scene, std::shared_ptr<const Model> model, std::unique_ptr<Backend> backend,
                       const SimulationOptions& options)
    : scene_(std::move(scene)), model_(std::move(model)), backend_(std::move(backend)) {
  start(options);
}

void Simulation::load_program() { install(build_program(*model_, {scene_.integrator, batch_steps_}), nullptr); }

/// Load the model's program, in place of the one that is loaded or, with `complete`, over it (Backend::update).
void Simulation::install(Program program, const std::function<void()>& complete) {
  const Program loaded = std::exchange(program_, std::move(program));
  if (complete != nullptr) {
    backend_->update(loaded, program_, complete);
    for (Buffer& buffer : program_.buffers) buffer.changed.reset();  // it says nothing about the next program
  } else {
    backend_->load(program_);
  }
  u_ = program_.find("node_u");
  w_ = program_.find("node_w");
  kept_.clear();
  for (std::size_t id = 0; id < program_.buffers.size(); ++id) {
    const std::string& name = program_.buffers[id].name;
    if (name.starts_with("last_")) {
      kept_.emplace_back(program_.find(name == "last_u"   ? "node_u"
                                       : name == "last_w" ? "node_w"
                                                          : name.substr(5)),
                         static_cast<BufferId>(id));
    }
  }
  force_ = program_.find("node_force");
  free_.assign(3 * static_cast<std::size_t>(model_->slots), false);
  for (std::size_t s = 0; s < model_->mass.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) free_[3 * s + c] = model_->mass[s] > 0;
  }
  for (const Constraint& constraint : model_->constraints) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (constraint.axes & (1 << c)) free_[3 * static_cast<std::size_t>(constraint.slot) + c] = false;
    }
  }
  if (!host_forces_.empty()) upload_host_forces();
}

void Simulation::start(const SimulationOptions& options) {
  batch_steps_ = options.batch_steps;
  load_program();
  for (const Curve& curve : model_->curves) {
    double end = curve.start + curve.duration;
    if (!curve.table.empty()) end = std::max(end, curve.table.back()[0]);
    curves_end_ = std::max(curves_end_, end);
  }
  const double wanted = options.dt > 0 ? options.dt : scene_.dt;
  automatic_ = wanted <= 0 && scene_.integrator == Integrator::increment;
  choose_dt(wanted, options.stable_step);
  if (!(state_.dt > 0) || !std::isfinite(state_.dt)) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("no stable step could be found (estimate {} s): nothing in the scene can move freely", state_.stable_dt));
  }
  first_dt_ = state_.dt;
  prepare_blades();
  prepare_tears();
  // Squares and cubes of what is left stay normal numbers; the double oracle needs neither floor nor grid.
  if (backend_->info().name != "cpu:double") {
    still_ = 1e-12 * model_->shortest;
    fine_ = std::ldexp(1.0, 22 + std::ilogb(still_));
  }
  upload_shape_matching();
  set_initial_increment();
}

/// w_0 = h v_0 - h^2/2 a_0, so that the first step is that of a parabola through the initial position and velocity.
void Simulation::set_initial_increment() {
  const std::vector<double> force = forces_now();
  std::vector<double> w(4 * static_cast<std::size_t>(model_->slots));
  const double sign = scene_.integrator == Integrator::textbook ? -1 : 1;  // the textbook form keeps u_(-1) instead
  for (std::size_t s = 0; s < model_->mass.size(); ++s) {
    const double h = substeps_of(s) * state_.dt;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!free_[3 * s + c]) continue;
      const double a = force[4 * s + c] / model_->mass[s] + scene_.gravity[c] - model_->damping[s] * model_->velocity[s][c];
      w[4 * s + c] = sign * (h * model_->velocity[s][c] - 0.5 * h * h * a);
    }
    w[4 * s + 3] = decay(s);
  }
  backend_->write_reals(w_, w);
}

void Simulation::upload_params() {
  const Vec3d& g = scene_.gravity;
  backend_->write_reals(program_.find("step_params"),
                        {state_.dt, g[0], g[1], g[2], still_, fine_, static_cast<double>(phase()), 0});
}

/// a = (1 - k) / (1 + k) with k = c h / 2, c the material's damping rate plus that of dynamic relaxation.
double Simulation::decay(std::size_t slot) const {
  const double k = 0.5 * substeps_of(slot) * state_.dt * (model_->damping[slot] + state_.damping);
  return (1 - k) / (1 + k);
}

void Simulation::upload_decay() {
  std::vector<double> w = backend_->read_reals(w_);
  for (std::size_t s = 0; s < model_->mass.size(); ++s) w[4 * s + 3] = decay(s);
  backend_->write_reals(w_, w);
}

void Simulation::upload_curves(std::int32_t steps) {
  std::vector<double> values;
  const std::size_t rows = static_cast<std::size_t>(batch_steps_) + 1;
  values.reserve(rows * model_->curves.size());
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = time_at(state_.step + std::min<std::int64_t>(static_cast<std::int64_t>(row), steps));
    for (const Curve& curve : model_->curves) values.push_back(curve.value(t));
  }
  backend_->write_reals(program_.find("curve_value"), values);
}

std::vector<double> Simulation::forces_now() {
  upload_params();
  upload_curves(0);
  backend_->run(program_.force, 0, 1);
  return backend_->read_reals(force_);
}

std::int32_t Simulation::next_batch(std::int64_t wanted) const {
  // Batches end at fixed step numbers, so that a resumed run looks and adapts exactly where an uninterrupted one does.
  std::int64_t n = 1;
  while (n < batch_steps_ && !on_grid(state_.step + n)) ++n;
  return static_cast<std::int32_t>(std::min(n, wanted));
}

void Simulation::begin_batch(std::int32_t steps) {
  if (on_grid(state_.step)) {
    move_blades();
    tear();
    follow_tool();
  }
  if (adapts_at(state_.step)) adapt_dt();
  if (on_grid(state_.step) || state_.vectors.count("kept") == 0) keep_state();
  upload_params();
  upload_curves(steps);
}

/// Steps at which batches begin however a run is cut into pieces: only these states are kept to go back to.
bool Simulation::on_grid(std::int64_t step) const {
  return begins_after(step, batch_steps_) || adapts_at(step) || (blade_steps_ > 0 && begins_after(step, blade_steps_)) ||
         (tears_ != nullptr && begins_after(step, kTearSteps)) || (scene_.relaxation.enabled && step % kRelaxEvery == 0);
}

void Simulation::keep_state() {
  for (const auto& [live, copy] : kept_) backend_->copy(live, copy);
  state_.vectors["kept"] = {static_cast<double>(state_.step), static_cast<double>(state_.origin_step), state_.origin_time,
                            state_.dt, state_.damping};
}

void Simulation::return_to_kept() {
  for (const auto& [live, copy] : kept_) backend_->copy(copy, live);
  backend_->finish();
  const std::vector<double>& kept = state_.vectors.at("kept");
  state_.step = static_cast<std::int64_t>(kept[0]);
  state_.origin_step = static_cast<std::int64_t>(kept[1]);
  state_.origin_time = kept[2];
  state_.dt = kept[3];
  state_.damping = kept[4];
}

void Simulation::end_batch(std::int32_t steps) {
  const std::int64_t start = state_.step;
  state_.step += steps;
  look_for_fault(start);
  if (!divergence_ && scene_.relaxation.enabled && state_.step % kRelaxEvery == 0) relax();
}

std::int64_t Simulation::advance(std::int64_t steps) {
  const std::int64_t first = state_.step;
  while (state_.step - first < steps && !divergence_ && !equilibrium_) {
    const std::int32_t n = next_batch(steps - (state_.step - first));
    begin_batch(n);
    backend_->run(program_.step, 0, n, state_.step);
    end_batch(n);
  }
  return state_.step - first;
}

void Simulation::look_for_fault(std::int64_t batch_start) {
  // The steps looked at the states they started from; the last state is looked at here, before it can pass for a good one.
  backend_->run(program_.force, static_cast<std::int32_t>(state_.step - batch_start), 1);
  backend_->run(program_.status, 0, 1);
  const std::vector<std::int32_t> summary = backend_->read_ints(program_.find("fault_summary"));
  std::int32_t step = 0, place = 0;
  for (std::size_t i = 0; i < summary.size(); i += 2) {
    if (summary[i] == 0) continue;
    if (step == 0 || summary[i] < step || (summary[i] == step && summary[i + 1] < place)) {
      step = summary[i];
      place = summary[i + 1];
    }
  }
  if (step == 0) return;
  return_to_kept();
  if (retry_smaller()) return;
  const FaultPlace found = find_fault(*model_, place);
  Divergence d;
  d.step = batch_start + step;
  d.time = time_at(d.step - 1);
  d.body = found.body >= 0 ? model_->bodies[static_cast<std::size_t>(found.body)].name : "?";
  d.element = found.element;
  d.node = found.node;
  d.dt = state_.dt;
  d.stable_dt = state_.stable_dt;
  d.last_good_step = state_.step;
  divergence_ = d;
}

/// An automatic step may have been overtaken by a fast load: go back to the state kept last and take it in smaller steps. False
/// when the step is the user's, or when smaller steps have not helped.
bool Simulation::retry_smaller() {
  if (!automatic_) return false;
  state_.caution *= 0.7;
  if (state_.caution < kLeastCaution) return false;
  backend_->write_ints(program_.find("fault"), std::vector<std::int32_t>(program_.buffers[program_.find("fault")].count, 0));
  change_dt(std::min(0.7 * state_.dt, state_.caution * scene_.safety * estimate_stable_dt(kAdaptIterations)));
  return true;
}

void Simulation::change_dt(double dt) {
  const double ratio = dt / state_.dt;
  if (scene_.integrator == Integrator::textbook) return;  // its previous position belongs to the old step
  std::vector<double> w = backend_->read_reals(w_);
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (i % 4 != 3) w[i] *= ratio;
  }
  state_.origin_time = time_at(state_.step);
  state_.origin_step = state_.step;
  state_.dt = dt;
  for (std::size_t s = 0; s < model_->mass.size(); ++s) w[4 * s + 3] = decay(s);
  backend_->write_reals(w_, w);
  upload_shape_matching();
}

bool Simulation::adapts_at(std::int64_t step) const {
  if (!automatic_ || step == 0) return false;
  const bool first = std::any_of(std::begin(kFirstAdapts), std::end(kFirstAdapts),
                                 [&](std::int64_t k) { return step < 2 * k && begins_after(step, k); });
  return first || (step >= kAdaptEvery && begins_after(step, kAdaptEvery));
}

/// Follow the stable step of the deformed body down at once, and up again to the first step once it has recovered by a tenth.
void Simulation::adapt_dt() {
  const double allowed = std::min(first_dt_, state_.caution * scene_.safety * estimate_stable_dt(kAdaptIterations));
  if (allowed < state_.dt || allowed > 1.1 * state_.dt || (allowed == first_dt_ && state_.dt < first_dt_)) change_dt(allowed);
}

std::vector<Vec3d> Simulation::pick(const std::vector<double>& texels, std::size_t body, double factor) const {
  std::vector<Vec3d> out;
  out.reserve(model_->bodies.at(body).slot.size());
  for (const std::int32_t s : model_->bodies[body].slot) {
    const double* t = &texels[4 * static_cast<std::size_t>(s)];
    out.push_back({factor * t[0], factor * t[1], factor * t[2]});
  }
  return out;
}

std::vector<Vec3d> Simulation::displacements(std::size_t body) const { return pick(backend_->read_reals(u_), body, 1); }

std::vector<Vec3d> Simulation::velocities_from(const std::vector<double>& w, std::size_t body) const {
  std::vector<Vec3d> v = pick(w, body, 1 / state_.dt);
  for (std::size_t n = 0; n < v.size() && !model_->flsm.empty(); ++n) {
    const auto slot = static_cast<std::size_t>(model_->bodies[body].slot[n]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (free_[3 * slot + c]) v[n][c] /= substeps_of(slot);  // a prescribed component moves in every substep
    }
  }
  return v;
}

std::vector<Vec3d> Simulation::velocities(std::size_t body) const {
  if (scene_.integrator == Integrator::increment) return velocities_from(backend_->read_reals(w_), body);
  std::vector<double> u = backend_->read_reals(u_);
  const std::vector<double> before = backend_->read_reals(w_);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= before[i];
  return pick(u, body, 1 / state_.dt);
}

std::vector<Vec3d> Simulation::residual_forces(std::size_t body) { return pick(forces_now(), body, 1); }

std::vector<Vec3d> Simulation::surface_positions() {
  if (program_.surface.empty()) return {};
  backend_->run(program_.surface, 0, 1);
  const std::vector<double> x = backend_->read_reals(program_.find("surface_x"));
  std::vector<Vec3d> out(model_->surface.rest.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = {x[4 * v], x[4 * v + 1], x[4 * v + 2]};
  return out;
}

std::uint64_t Simulation::hash() const {
  std::uint64_t h = 0;
  for (const BufferId id : {u_, w_}) {
    const auto bytes = backend_->read_bytes(id);
    h = hash_bytes(bytes.data(), bytes.size(), h);
  }
  return h;
}

std::uint64_t Simulation::model_hash() const {
  std::uint64_t h = 0;
  const auto add = [&](const void* data, std::size_t bytes) { h = hash_bytes(data, bytes, h); };
  for (const Buffer& b : program_.buffers) {
    if (b.role != BufferRole::constant && b.name != "node_u" && b.name != "node_w") continue;
    add(b.name.data(), b.name.size());
    add(b.reals.data(), b.reals.size() * sizeof(double));
    add(b.ints.data(), b.ints.size() * sizeof(std::int32_t));
  }
  for (const Pass& p : program_.step) {
    add(p.kernel.data(), p.kernel.size());
    for (const auto& [name, value] : p.defines) {
      add(name.data(), name.size());
      add(&value, sizeof value);
    }
    for (const Arg& a : p.args) {
      if (const double* real = std::get_if<1>(&a)) add(real, sizeof *real);
    }
  }
  for (const Curve& c : model_->curves) {
    const double numbers[3]{static_cast<double>(c.kind), c.start, c.duration};
    add(numbers, sizeof numbers);
    add(c.table.data(), c.table.size() * sizeof c.table[0]);
  }
  const double relaxed = scene_.relaxation.enabled ? 1 : 0;
  const double settings[6]{scene_.gravity[0], scene_.gravity[1], scene_.gravity[2], scene_.dt, scene_.safety, relaxed};
  add(settings, sizeof settings);
  for (const Blade& blade : scene_.blades) {
    const double when[2]{blade.start, blade.end};
    add(blade.name.data(), blade.name.size());
    add(when, sizeof when);
    add(blade.path.data(), blade.path.size() * sizeof blade.path[0]);
  }
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    if (!scene_.bodies[b].model.cut) add(&b, sizeof b);
  }
  return h;
}

}  // namespace pliant
