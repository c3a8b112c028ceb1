#include "simulation/step_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pliant/error.h"
#include "simulation/coupling.h"
#include "simulation/stable_step.h"

namespace pliant {
namespace {

/// An automatic step is looked at again every few hundred steps, and sooner after the start, when loads come on.
constexpr std::int64_t kAdaptEvery = 256;
constexpr std::int64_t kFirstAdapts[] = {64, 128};
constexpr int kAdaptIterations = 20;
/// A diverged batch is tried again with a smaller automatic step until that is this share of what the estimate allows.
constexpr double kLeastBackoff = 0.1;
constexpr double kLeastStep = 0.02;  ///< share of the first step below which inverted elements shorten it no more
constexpr double kFrame = 1.0 / 60;  ///< automatic step of a scene without finite elements [s]

}  // namespace

void StepControl::start(double wanted, bool estimate_always) {
  const Model& model = run_.model();
  const double longest = longest_step(model, run_.scene);
  double& dt = run_.state.clock.dt;
  run_.settings.automatic = wanted <= 0 && run_.scene.integrator == Integrator::increment && has_elements(model);
  if (!has_elements(model)) {
    dt = wanted > 0 ? wanted : std::min(kFrame, longest);
  } else {
    StableStep stable;
    if (wanted <= 0 || estimate_always) stable = estimate_stable_step(run_, 48);
    run_.state.limit.stable_dt = stable.coupled;
    dt = wanted > 0 ? wanted : std::min(run_.scene.safety * stable.coupled, longest);
    // Every cut leaves elements that are stable at the element bound: each copy's mass and stiffness scale alike.
    if (wanted <= 0 && !run_.scene.blades.empty()) {
      dt = std::min(dt, run_.scene.safety * coupled_step(model, model.element_bound));
    }
    if (wanted > 0) check_beta(run_, wanted, stable.elements);
  }
  if (!(dt > 0) || !std::isfinite(dt)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("no stable step could be found (estimate {} s): nothing in the scene can move freely",
                            run_.state.limit.stable_dt));
  }
  run_.state.limit.dt_ceiling = dt;
}

double StepControl::estimate(int iterations) {
  return run_.state.limit.stable_dt = estimate_stable_step(run_, iterations).coupled;
}

bool StepControl::on_grid(std::int64_t step) const {
  const RunSettings& s = run_.settings;
  return run_.begins_after(step, s.batch_steps) || adapts_at(step) ||
         (s.blade_steps > 0 && run_.begins_after(step, s.blade_steps)) || (s.tears && run_.begins_after(step, kTearSteps)) ||
         (run_.scene.relaxation.enabled && step % kRelaxEvery == 0);
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

void StepControl::adapt() {
  if (!run_.settings.automatic) return;
  const StepLimit& limit = run_.state.limit;
  const double dt = run_.state.clock.dt, ceiling = limit.dt_ceiling;
  const double allowed = std::min(ceiling, limit.dt_backoff * run_.scene.safety * estimate(kAdaptIterations));
  const bool may_grow = run_.state.clock.step >= limit.hold;
  if (allowed < dt || (may_grow && (allowed > 1.1 * dt || (allowed == ceiling && dt < ceiling)))) change(allowed);
}

void StepControl::limit_to_element_bound() {
  if (!run_.settings.automatic || run_.model().element_bound <= 0) return;
  double& ceiling = run_.state.limit.dt_ceiling;
  ceiling = std::min(ceiling, run_.scene.safety * coupled_step(run_.model(), run_.model().element_bound));
  if (run_.state.clock.dt > ceiling) change(ceiling);
}

std::optional<double> StepControl::outgrown() {
  const StepLimit& limit = run_.state.limit;
  const double dt = run_.state.clock.dt, least = kLeastStep * limit.dt_ceiling;
  if (!run_.settings.automatic || dt <= least) return {};
  const double stable = limit.dt_backoff * run_.scene.safety * estimate(kAdaptIterations);
  if (stable >= dt) return {};
  return std::max({stable, 0.35 * dt, least});
}

void StepControl::shorten(double dt) {
  run_.state.limit.hold = run_.state.clock.step + kAdaptEvery;
  change(dt);
}

bool StepControl::retry_smaller() {
  if (!run_.settings.automatic) return false;
  double& backoff = run_.state.limit.dt_backoff;
  backoff *= 0.7;
  if (backoff < kLeastBackoff) return false;
  run_.loaded.clear_faults();
  change(std::min(0.7 * run_.state.clock.dt, backoff * run_.scene.safety * estimate(kAdaptIterations)));
  return true;
}

/// Increments scale with the step, decay factors and shape matching follow it.
void StepControl::change(double dt) {
  Clock& clock = run_.state.clock;
  if (run_.scene.integrator == Integrator::textbook) return;  // its previous position belongs to the old step
  const double ratio = dt / clock.dt;
  std::vector<double> w = run_.loaded.w();
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (i % 4 != 3) w[i] *= ratio;
  }
  clock = {clock.step, clock.step, clock.time(), dt};
  for (std::size_t s = 0; s < run_.model().mass.size(); ++s) w[4 * s + 3] = run_.decay(run_.model(), s);
  run_.loaded.write_w(w);
  upload_coupling(run_);
}

}  // namespace pliant
