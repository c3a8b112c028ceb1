#include "simulation/step/step_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "model/nodes/ballast.h"
#include "pliant/error.h"
#include "simulation/edits/carried_depths.h"
#include "simulation/recovery/ballast_swap.h"
#include "simulation/recovery/limits.h"
#include "simulation/step/coupling.h"
#include "simulation/step/stable_step.h"

namespace pliant {
namespace {

/// An automatic step is checked every few hundred steps, and earlier after the start, when loads increase.
constexpr std::int64_t kAdaptEvery = 256;
constexpr std::int64_t kFirstAdapts[] = {64, 128};
constexpr int kAdaptIterations = 20;
constexpr double kMostGrowth = 2;     ///< largest growth of the step between two checks
constexpr double kClearlyLess = 0.8;  ///< margin: the estimate after kAdaptIterations iterations is up to a tenth too low
constexpr double kFrame = 1.0 / 60;   ///< automatic step of a scene without finite elements [s]
constexpr double kTouchFrame = kFrame / 16;  ///< automatic step with tissue contact, so that each frame searches for pairs

double total(const std::vector<NodeInertia>& ballast) {
  double sum = 0;
  for (const NodeInertia& b : ballast) sum += b.inertia;
  return sum;
}

}  // namespace

void StepControl::start(double wanted, bool estimate_always) {
  const Model& model = run_.model();
  const double longest = longest_step(model, run_.scene);
  double& dt = run_.state.clock.dt;
  run_.settings.automatic = wanted <= 0 && integrator_info(run_.scene.integrator).automatic && has_elements(model);
  const double frame = run_.scene.contact ? kTouchFrame : kFrame;
  if (!has_elements(model)) {
    dt = wanted > 0 ? wanted : std::min(frame, longest);
  } else {
    if (wanted <= 0 && !(stable_step(run_, 1) > 0)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: no step is stable with the integrator {} and a material without damping: "
                              "give each a \"damping\", or the scene a \"dt\"",
                              run_.scene.name, integrator_info(run_.scene.integrator).word));
    }
    StableStep stable;
    if (wanted <= 0 || estimate_always) stable = estimate_stable_step(run_, 48);
    run_.state.limit.stable_dt = stable.coupled;
    dt = wanted > 0 ? wanted : std::min(run_.scene.safety * stable.coupled, longest);
    if (wanted <= 0 && !model.flsm.empty() && !has_finite_elements(model)) dt = std::min(dt, frame);  // of links alone
    // Every cut leaves elements that are stable at the element bound: the mass and stiffness of each copy scale alike. (Those
    // of membranes and vessels do not, and an automatic step follows the bound after a cut.) Slack springs pull only when they
    // are longer than at rest, and an estimate there sees some of them.
    const auto slack = [](const SpringBatch& b) { return b.law.slack; };
    const bool any_slack = std::any_of(model.links.springs.begin(), model.links.springs.end(), slack);
    if (wanted <= 0 && (!run_.scene.blades.empty() || any_slack)) {
      dt = std::min(dt, run_.scene.safety * bound_step(run_, model.element_bound));
    }
    if (wanted > 0) check_beta(run_, wanted, stable.elements);
  }
  if (!(dt > 0) || !std::isfinite(dt)) refuse_step();
  run_.state.limit.dt_ceiling = run_.settings.first_dt = dt;
}

void StepControl::refuse_step() const {
  const std::vector<char>& is_free = run_.loaded.free();
  const bool moves = std::find(is_free.begin(), is_free.end(), 1) != is_free.end();
  const std::string why =
      moves ? fmt::format(
                  "the elements give no finite forces on {} ({}); \"young\" and \"density\" may exceed the range of a "
                  "float, or the device computes wrongly, which \"pliant compare\" shows",
                  run_.backend().info().name, run_.backend().info().device)
            : std::string(
                  "\"fixed\" and \"prescribed\" hold every node of every body, and nothing is left that could move; "
                  "choose smaller regions there");
  throw Error(ErrorCode::bad_input, fmt::format("{}: no stable step could be found (estimate {} s): {}", run_.scene.name,
                                                run_.state.limit.stable_dt, why));
}

double StepControl::estimate(int iterations) {
  std::vector<double> u = run_.loaded.u();
  const double time = run_.state.clock.time();
  const std::shared_ptr<const Model>& model = run_.loaded.shared_model();  // another one after every edit
  const std::vector<HostForce>& forces = run_.state.forces;
  if (last_.model != model || last_.time != time || last_.iterations != iterations || last_.u != u || last_.forces != forces) {
    const double dt = estimate_stable_step(run_, iterations).coupled;
    last_ = {model, std::move(u), forces, time, iterations, dt};
  }
  return run_.state.limit.stable_dt = last_.dt;
}

bool StepControl::on_grid(std::int64_t step) const {
  const RunSettings& s = run_.settings;
  return run_.begins_after(step, s.batch_steps) || adapts_at(step) ||
         (s.blade_steps > 0 && run_.begins_after(step, s.blade_steps)) ||
         ((s.tears || s.breaks) && run_.begins_after(step, kTearSteps)) ||
         (run_.scene.relaxation.enabled && run_.begins_after(step, kRelaxEvery)) || changes_at(step);
}

/// Returns true at the step of the last change of parameters, and at the first one where the scene's next can be made.
bool StepControl::changes_at(std::int64_t step) const {
  if (run_.state.changed.step == step) return true;
  const auto done = static_cast<std::size_t>(run_.state.changed.done);
  if (done >= run_.scene.changes.size()) return false;
  const double time = run_.scene.changes[done].time;
  const std::int64_t period = run_.period();
  return step % period == 0 && run_.reached(time, step) && !run_.reached(time, step - period);
}

std::int32_t StepControl::next_batch(std::int64_t wanted) const {
  std::int64_t n = 1;
  while (n < run_.settings.batch_steps && !on_grid(run_.state.clock.step + n)) ++n;
  return static_cast<std::int32_t>(std::min(n, wanted));
}

bool StepControl::adapts_at(std::int64_t step) const {
  if (!run_.settings.automatic || step == 0) return false;
  const bool first = std::any_of(std::begin(kFirstAdapts), std::end(kFirstAdapts),
                                 [&](std::int64_t k) { return step < 2 * k && run_.begins_after(step, k); });
  return first || (step >= kAdaptEvery && run_.begins_after(step, kAdaptEvery));
}

void StepControl::adapt_when_due() {
  if (adapts_at(run_.state.clock.step)) adapt();
}

/// Returns true if the step is automatic and something is left that limits it: of a network all of whose springs are cut
/// nothing is.
bool StepControl::follows() const { return run_.settings.automatic && has_elements(run_.model()); }

void StepControl::adapt() {
  if (!follows()) return;
  const StepLimit& limit = run_.state.limit;
  Allowed now = allowed();
  if (now.dt < least_step() || !run_.state.ballast.empty()) {
    now.dt = balance(now.dt, full_stiffness(now));
  }
  const double viscous = std::min(1.0, rates_step(run_, kAdaptIterations) / now.estimate);
  run_.state.limit.stable_dt *= viscous;
  now.dt *= viscous;
  const double dt = run_.state.clock.dt, ceiling = limit.dt_ceiling;
  const bool may_grow = run_.state.clock.step >= limit.hold;
  if (may_grow) run_.state.limit.dt_backoff = std::min(1.0, limit.dt_backoff / kBackoff);
  // A state that requires less than this has lost elements. They are calmed, which a step that follows them would prevent.
  const double lowest = std::min(dt, kLeastShare * ceiling);
  const double next = std::max(lowest, std::min({ceiling, now.dt, kMostGrowth * dt}));
  if (next < dt || (may_grow && (next > 1.1 * dt || (next == ceiling && dt < ceiling)))) change(next);
}

void StepControl::adapt_after_move() {
  if (!run_.settings.automatic) return;
  const StepLimit& limit = run_.state.limit;
  if (run_.state.ballast.empty() && run_.state.clock.dt == limit.dt_ceiling && clearly_allows({})) return;
  adapt();
}

/// Returns true if a bound of the elements that `changed` marks (empty: of all) shows that the present step is not clearly too
/// long.
bool StepControl::clearly_allows(const std::vector<char>& changed) const {
  const std::vector<double> u = run_.loaded.u();
  for (const bool quick : {true, false}) {
    const double bound = stiffness_bound(run_.model(), nodal_stiffness(run_.model(), u, changed, quick));
    if (bound > 0 && share() * bound_step(run_, bound) >= kClearlyLess * run_.state.clock.dt) return true;
  }
  return false;
}

double StepControl::least_step() const {
  const StepLimit& limit = run_.state.limit;
  return run_.scene.least_step * limit.dt_ceiling;
}

/// Fraction of the stable step that is used.
double StepControl::share() const { return run_.state.limit.dt_backoff * run_.scene.safety; }

double StepControl::estimated() { return share() * estimate(kAdaptIterations); }

double StepControl::networks_allow() const { return run_.scene.safety * network_step(run_); }

bool StepControl::bound_allows() const {
  const double bound = stiffness_bound(run_.model(), nodal_stiffness(run_.model(), run_.loaded.u(), {}, true));
  return bound > 0 && run_.scene.safety * bound_step(run_, bound) >= run_.state.clock.dt;
}

StepControl::Allowed StepControl::allowed() {
  StepLimit& limit = run_.state.limit;
  Allowed out{estimated(), 0, {}};
  out.estimate = limit.stable_dt;
  if (out.dt >= run_.state.clock.dt) return out;
  // The estimate takes differences of forces, which are mostly rounding far from the rest position. The element bound is
  // coarser but reliable, since it is computed in double. It is at most that of any one node, which is nearly always below the
  // estimate: of the node that was the stiffest last, or else of the one that a quick bound takes for it.
  const std::vector<double> u = run_.loaded.u();
  const auto is_below = [&] {
    std::vector<char> one(run_.model().mass.size());
    if (stiffest_ >= one.size()) return false;
    one[stiffest_] = 1;
    const double most = stiffness_bound(run_.model(), nodal_stiffness(run_.model(), u, one));
    return most > 0 && bound_step(run_, most) <= limit.stable_dt;
  };
  if (is_below()) return out;
  stiffest_ = stiffest_node(run_.model(), nodal_stiffness(run_.model(), u, {}, true));
  if (is_below()) return out;
  out.stiffness = nodal_stiffness(run_.model(), u);
  stiffest_ = stiffest_node(run_.model(), out.stiffness);
  const double bound = stiffness_bound(run_.model(), out.stiffness);
  if (bound > 0) limit.stable_dt = std::max(limit.stable_dt, bound_step(run_, bound));
  out.dt = share() * limit.stable_dt;
  return out;
}

const std::vector<double>& StepControl::full_stiffness(Allowed& now) const {
  if (now.stiffness.empty()) now.stiffness = nodal_stiffness(run_.model(), run_.loaded.u());
  return now.stiffness;
}

std::vector<NodeInertia> StepControl::ballast_for(double dt, const std::vector<double>& stiffness) const {
  return wanted_ballast(run_.model(), stiffness, central_step_for(run_, dt / share()));
}

bool StepControl::too_much(const std::vector<NodeInertia>& ballast) const {
  double mass = 0;
  for (const ModelBody& body : run_.model().bodies) mass += body.mass;
  return total(ballast) > kMostBallast * mass;
}

std::vector<NodeInertia> StepControl::more_ballast(double dt, const std::vector<double>& stiffness) const {
  std::vector<NodeInertia> ballast = ballast_for(dt, stiffness);
  if (too_much(ballast) || total(ballast) <= total(run_.state.ballast)) ballast.clear();
  return ballast;
}

double StepControl::balance(double wanted, const std::vector<double>& stiffness) {
  double dt = std::max(wanted, least_step());
  std::vector<NodeInertia> ballast = ballast_for(dt, stiffness);
  while (dt > wanted && too_much(ballast)) {
    dt = std::max(wanted, kBallastStride * dt);
    ballast = ballast_for(dt, stiffness);
  }
  if (too_much(ballast)) ballast.clear();  // the element bound that requires it is far from the measured value
  const auto same = [](const NodeInertia& a, const NodeInertia& b) { return a.slot == b.slot && a.inertia == b.inertia; };
  const std::vector<NodeInertia>& before = run_.state.ballast;
  if (!std::equal(ballast.begin(), ballast.end(), before.begin(), before.end(), same)) load_ballast(run_, std::move(ballast));
  return dt;
}

void StepControl::limit_after_edit(const std::vector<char>& changed) {
  if (!follows()) return;
  double& ceiling = run_.state.limit.dt_ceiling;
  if (run_.model().element_bound > 0)
    ceiling = std::min(ceiling, run_.scene.safety * bound_step(run_, run_.model().element_bound));
  if (run_.state.clock.dt > ceiling) change(ceiling);
  // New elements are stretched like those they come from, on nodes of less mass. Undeformed, the bound above is safe. For
  // deformed elements a bound is cheaper than the estimate and only needs the changed ones; with shape matching all nodes are
  // included, since the interface depends on the step that all of them allow.
  if (clearly_allows(run_.model().flsm.empty() ? changed : std::vector<char>())) return;
  const double next = std::max(allowed().dt, least_step());
  if (next < kClearlyLess * run_.state.clock.dt) change(next);
}

void StepControl::follow_parameters(double before) {
  const double bound = run_.model().element_bound;
  if (run_.settings.automatic && before > 0 && bound > 0) {
    double& ceiling = run_.state.limit.dt_ceiling;
    ceiling = std::min(ceiling * bound_step(run_, bound) / before, longest_step(run_.model(), run_.scene));
    if (run_.state.clock.dt > ceiling) change(ceiling);
    adapt();
  } else if (has_elements(run_.model())) {
    estimate();
  }
}

void StepControl::hold() { run_.state.limit.hold = run_.state.clock.step + kAdaptEvery; }

/// Rescales increments, decay factors and shape matching to the new step.
void StepControl::change(double dt) {
  Clock& clock = run_.state.clock;
  if (!integrator_info(run_.scene.integrator).automatic) return;
  const double ratio = dt / clock.dt;
  std::vector<double> w = run_.loaded.w();
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (i % 4 != 3) w[i] *= ratio;
  }
  clock = {clock.step, clock.step, clock.time(), dt};
  for (std::size_t s = 0; s < run_.model().mass.size(); ++s) w[4 * s + 3] = run_.decay(run_.model(), s);
  run_.loaded.write_w(w);
  follow_step(run_, ratio);
  upload_coupling(run_);
}

}  // namespace pliant
