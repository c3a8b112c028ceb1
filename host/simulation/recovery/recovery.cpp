#include "simulation/recovery/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "layout.h"
#include "schedule/build_program.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/recovery/ballast_swap.h"
#include "simulation/recovery/calm.h"
#include "simulation/recovery/limits.h"

namespace pliant {
namespace {

const std::string& body_name(const Model& model, std::int32_t body) {
  static const std::string unknown = "?";
  return body >= 0 ? model.bodies[static_cast<std::size_t>(body)].name : unknown;
}

FaultLocation node_at(const Model& model, std::int32_t slot) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<std::int32_t>& slots = model.bodies[b].slot;
    const auto node = std::find(slots.begin(), slots.end(), slot);
    if (node != slots.end()) return {static_cast<std::int32_t>(b), node - slots.begin(), true};
  }
  return {};
}

}  // namespace

std::string Divergence::message() const {
  return fmt::format(
      "the simulation diverged in step {} (t = {:.6g} s): {} {} of body '{}' is {}not finite; dt = {:.6g} s, "
      "stable step "
      "{:.6g} s ({:.3g} times); the state of step {} was kept",
      step, time, node ? "node" : "element", element, body, node ? "" : "inverted or ", dt, stable_dt,
      stable_dt > 0 ? dt / stable_dt : 0.0, last_good_step);
}

void Recovery::keep(bool on_grid) {
  const auto good = [&] {
    // With a user-given step a run may burst long before a value overflows; do not keep a state that is flying apart.
    if (run_.settings.automatic || !integrator_info(run_.scene.integrator).keeps_increment) return true;
    run_.backend().run(run_.loaded.program().status, 0, 1);
    return run_.loaded.largest_increment() <= kBurst * run_.model().shortest;
  };
  RunState& state = run_.state;
  if (state.kept && !(on_grid && good())) return;
  run_.loaded.keep_state();
  state.kept = KeptState{state.clock, state.relaxation.damping, state.pressed};
  const double needed = state.clock.time_at(state.clock.step - 2);  // velocities and work take the step before
  forget_drives(state.driven, needed);
  forget_drives(state.driven_blades, needed);
  reports_.kept = reports_.now;
}

std::optional<Divergence> Recovery::look(std::int64_t batch_start) {
  // Each step checks the state it starts from, so the batch's final state is still unchecked. Check it before it can be kept.
  Symptoms s = read(batch_start, static_cast<std::int32_t>(run_.state.clock.step - batch_start));
  shorter_ = 0;
  reports_.now.inversions.last = 0;
  if (s.lost_in == 0 && s.inverted > 0) count_inversions(s);
  for (const Remedy remedy : remedies) {
    if ((this->*remedy)(s)) break;
  }
  return std::move(s.divergence);
}

Symptoms Recovery::read(std::int64_t batch_start, std::int32_t step_in_batch) const {
  run_.backend().run(run_.loaded.program().force, step_in_batch, 1);
  run_.backend().run(run_.loaded.program().status, 0, 1);
  const std::vector<std::int32_t> summary = run_.loaded.faults();
  Symptoms s;
  s.batch_start = batch_start;
  for (std::size_t i = 0; i < summary.size(); i += PLIANT_FAULT_SUMMARY) {
    if (summary[i + 2] > 0) {
      s.inverted_one = s.inverted == 0 ? summary[i + 3] : std::min(s.inverted_one, summary[i + 3]);
      s.inverted += summary[i + 2];
    }
    if (summary[i] == 0) continue;
    if (s.lost_in == 0 || std::pair(summary[i], summary[i + 1]) < std::pair(s.lost_in, s.lost)) {
      s.lost_in = summary[i];
      s.lost = summary[i + 1];
    }
  }
  if (s.lost_in > 0) return s;
  s.increment = run_.loaded.largest_increment();
  if (!std::isfinite(s.increment)) find_lost_node(s);
  return s;
}

/// Springs have no marks of their own.
void Recovery::find_lost_node(Symptoms& s) const {
  const std::vector<double> w = run_.loaded.w();
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (std::isfinite(w[i])) continue;
    s.lost_in = static_cast<std::int32_t>(std::max<std::int64_t>(1, run_.state.clock.step - s.batch_start));
    s.lost = -1;
    s.lost_slot = static_cast<std::int32_t>(i / 4);
    return;
  }
}

void Recovery::count_inversions(const Symptoms& s) {
  Inversions& all = reports_.now.inversions;
  if (all.batches == 0) {
    const FaultLocation found = find_fault(run_.model(), s.inverted_one);
    all.first_step = s.batch_start + 1;
    all.first_time = run_.state.clock.time_at(s.batch_start);
    all.body = body_name(run_.model(), found.body);
    all.element = found.element;
  }
  ++all.batches;
  all.last = s.inverted;
  all.most = std::max(all.most, s.inverted);
  run_.loaded.clear_faults();
}

double Recovery::fast_share() const { return std::min(1.0, 2 * run_.state.clock.dt / run_.state.limit.dt_ceiling); }

bool Recovery::may_trust_less() const {
  return run_.settings.automatic && kBackoff * run_.state.limit.dt_backoff >= kLeastBackoff;
}

bool Recovery::calm_down(Symptoms& s) {
  if (s.lost_in > 0) return false;
  // Decided by the state alone, and only where states are kept, since a run may be divided anywhere else.
  if (!run_.settings.automatic || !run_.state.kept || !step_.on_grid(run_.state.clock.step)) return true;
  look_at_networks(s);
  if (s.outgrown) return false;
  double fastest = 0;
  if (s.increment / run_.model().shortest > kFastIncrement * fast_share()) {
    const Calmed calmed = calm(run_, kFastest * fast_share());
    reports_.now.inversions.calmed += calmed.elements;
    fastest = calmed.fastest;
  }
  s.burst = fastest > kBurst && may_trust_less() && run_.state.clock.dt > step_.least_step();
  if (s.burst) return false;
  const auto inverted_now = [&] {
    const bool found = read(s.batch_start, 0).inverted > 0;
    run_.loaded.clear_faults();
    return found;
  };
  // Pieces in rigid flight do not deform faster.
  if (fastest <= kFastIncrement && (s.inverted == 0 || !inverted_now())) return true;
  measure(s);
  return !s.outgrown;
}

bool Recovery::quiet() const {
  run_.backend().run(run_.loaded.program().status, 0, 1);
  return run_.loaded.largest_increment() / run_.model().shortest <= kFastIncrement * fast_share();
}

void Recovery::look_at_networks(Symptoms& s) const {
  const double dt = run_.state.clock.dt, allowed = step_.networks_allow();
  // Springs have no remedy but the step: below that of the scene it is the least one that any state gets.
  const double lowest = dt > step_.least_step() ? step_.least_step() : kLeastBackoff * run_.state.limit.dt_ceiling;
  if (!(allowed < (1 - 1e-6) * dt) || dt <= lowest) return;
  s.outgrown = true;
  s.dt = std::max({std::min(allowed, kLeastShortening * dt), kMostShortening * dt, lowest});
}

void Recovery::measure(Symptoms& s) {
  if (step_.bound_allows()) return;
  const double dt = run_.state.clock.dt, least = step_.least_step(), ceiling = run_.state.limit.dt_ceiling;
  StepControl::Allowed now = step_.allowed();
  // Compare with the limit without the distrust, which also shortens the step: otherwise both would shrink together
  // indefinitely.
  if (now.dt / run_.state.limit.dt_backoff >= dt) return;
  double lowest = least;
  if (dt <= least) {
    // Below the shortest step only a lost state is treated: inverted elements that continue are driven back by their laws.
    if (!may_trust_less()) return;
    s.ballast = step_.more_ballast(dt, step_.full_stiffness(now));
    lowest = kLeastBackoff * ceiling;
    if (s.ballast.empty() && dt <= lowest) return;
  }
  s.dt = std::max({std::min(now.dt, kLeastShortening * dt), kMostShortening * dt, lowest});
  // Stable, but no longer by the safety: what came of the batch stays, unless substeps, which resonate, have made it.
  const bool stable = dt > least && run_.period() == 1 && now.dt >= run_.scene.safety * run_.state.limit.dt_backoff * dt;
  s.outgrown = !stable;
  if (stable) shorter_ = s.dt;
}

void Recovery::shorten() {
  const double dt = std::exchange(shorter_, 0);
  if (!(dt > 0)) return;
  step_.hold();
  step_.change(dt);
}

bool Recovery::go_back(Symptoms&) {
  RunState& state = run_.state;
  run_.loaded.return_to_kept_state();
  state.look.tools = state.look.tissue = -1;
  state.clock = state.kept->clock;
  state.relaxation.damping = state.kept->damping;
  state.pressed = state.kept->pressed;
  stand_where_placed();
  reports_.now.take_back(reports_.kept);
  return false;
}

/// A place that the host has chosen since is not left again: no way leads there.
void Recovery::stand_where_placed() {
  RunState& state = run_.state;
  const double now = state.clock.time();
  for (const Blade& blade : run_.scene.blades) {
    const auto own = state.driven_blades.find(blade.name), end = state.driven_blades.end();
    if (own == end || !stay_after_jumps(own->second, now, [&](double t) { return blade.at(t); })) continue;
    const auto pressed = state.pressed.find(blade.name);
    if (pressed != state.pressed.end()) pressed->second.forget_fronts();
  }
  for (const ContactTool& tool : known_tools(run_.scene, state.tools)) {
    const auto own = state.driven.find(tool.name);
    if (own != state.driven.end()) stay_after_jumps(own->second, now, [&](double t) { return tool.at(t); });
  }
}

bool Recovery::made_again() {
  reports_.now.inversions.calmed += calm(run_, kFastest * fast_share() * run_.state.limit.dt_backoff).elements;
  return true;
}

bool Recovery::fewer_substeps(Symptoms&) {
  if (!edits_.fewer_substeps()) return false;
  run_.loaded.clear_faults();
  return made_again();
}

bool Recovery::trust_less(Symptoms& s) {
  if (s.outgrown || !may_trust_less()) return false;
  double& backoff = run_.state.limit.dt_backoff;
  backoff *= kBackoff;
  step_.hold();
  run_.loaded.clear_faults();
  const double dt = run_.state.clock.dt, least = step_.least_step();
  const double next = std::min(kBackoff * dt, step_.estimated());
  // Neither directly below the floor nor far: one lost element would determine the step of the whole scene.
  step_.change(std::max(next, dt > least ? least : kMostShortening * dt));
  return made_again();
}

bool Recovery::add_ballast(Symptoms& s) {
  if (s.ballast.empty()) return false;
  step_.hold();
  load_ballast(run_, std::move(s.ballast));
  run_.state.limit.dt_backoff *= kBackoff;  // guarantees termination
  return made_again();
}

bool Recovery::shorter_step(Symptoms& s) {
  if (!s.outgrown) return false;
  step_.hold();
  step_.change(s.dt);
  return made_again();
}

bool Recovery::give_up(Symptoms& s) {
  const FaultLocation found = s.lost < 0 ? node_at(run_.model(), s.lost_slot) : find_fault(run_.model(), s.lost);
  const Clock& clock = run_.state.clock;
  s.divergence = Divergence{s.batch_start + s.lost_in,
                            clock.time_at(s.batch_start + s.lost_in - 1),
                            body_name(run_.model(), found.body),
                            found.element,
                            found.node,
                            clock.dt,
                            run_.state.limit.stable_dt,
                            clock.step};
  return true;
}

}  // namespace pliant
