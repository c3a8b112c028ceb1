// Stiffness and stability of shape matching and of its interface with finite elements.
#include "simulation/step/coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "geometry/vec.h"
#include "model/matching/matching_step.h"
#include "pliant/error.h"
#include "simulation/step/stable_step.h"

namespace pliant {
namespace {

/// Factor on beta while the interface force is active: see flsm_interface in program_flsm.cpp.
int pull_factor(const DeformationModel& m) { return m.extrapolate ? 1 : m.substeps; }

/// The step of the scene at which alpha reaches its limit, the longest that "stiffness" allows [s].
double longest_step(const FlsmBatch& batch, double damping) {
  return longest_matching_step(batch, damping) / batch.settings.substeps;
}

/// The alpha of a batch at the step `dt` of the scene [s] for the damping rate of its material [1/s]. A scene's alpha refers
/// to the first step, a "stiffness" to any step. Alpha decreases with the step: if the start is stable, every smaller step
/// is. Throws Error if a "stiffness" needs more than the largest alpha; an `automatic` step follows a changed one.
double alpha_for(const FlsmBatch& batch, double dt, double first_dt, double damping, bool automatic = false) {
  const DeformationModel& m = batch.settings;
  if (m.young <= 0) {
    // A constant alpha would stiffen a body whenever the step is shortened, which would shorten the step further.
    return dt < first_dt ? m.alpha * (step_square(m.substeps * dt, damping) / step_square(m.substeps * first_dt, damping))
                         : m.alpha;
  }
  const double b = step_square(m.substeps * dt, damping);
  const double largest = largest_alpha(batch), most = largest * stiffness_unit(batch) / b;
  if (m.young > 1.00001 * most && !m.matched && !automatic) {  // tolerate the digits of the message
    throw Error(ErrorCode::bad_input,
                fmt::format("{}/stiffness/young: got {} Pa, which no alpha reaches with width {} at dt = {:.6g} s{}; allowed "
                            "is at most {:.6g} Pa, "
                            "or dt up to {:.6g} s",
                            m.pointer, m.young, m.width, dt, m.substeps > 1 ? fmt::format(" and {} substeps", m.substeps) : "",
                            most, longest_step(batch, damping)));
  }
  return std::min(largest, largest * (m.young / most));
}

/// The mass at the position of each interface node [kg]: its own, or that of all its copies if a cut has split it. A given
/// beta belongs to the position; the copies share it in proportion to mass, otherwise a cut would stiffen the lighter ones.
std::vector<double> place_masses(const Model& model, const FlsmBatch& batch) {
  const ModelBody& body = model.bodies[static_cast<std::size_t>(batch.body)];
  std::map<Vec3d, double> sum;
  for (std::size_t n = 0; n < body.rest.size(); ++n) sum[body.rest[n]] += model.mass[static_cast<std::size_t>(body.slot[n])];
  std::map<std::int32_t, double> of_slot;
  for (std::size_t n = 0; n < body.rest.size(); ++n) of_slot[body.slot[n]] = sum[body.rest[n]];
  std::vector<double> masses;
  for (std::int32_t i = batch.own; i < batch.own + batch.interface; ++i) masses.push_back(of_slot[batch.slot[i]]);
  return masses;
}

double least_place_mass(const Model& model, const FlsmBatch& batch) {
  const std::vector<double> masses = place_masses(model, batch);
  return *std::min_element(masses.begin(), masses.end());
}

/// beta / m of an interface with automatic beta and a "stiffness" [1/s^2].
double spring_of(const FlsmBatch& b) { return b.settings.young / stiffness_unit(b); }

/// Upper bound of the active interface force relative to its beta: regions may be stiffer than the springs to their goals.
double pull_bound(const FlsmBatch& b) { return pull_factor(b.settings) * b.stiffest_interface; }

/// beta / m that a batch adds to omega^2 of its interface nodes: as a multiple of 1 / dt^2 (automatic beta), and as a
/// constant [1/s^2] (given beta, or automatic with an alpha that decreases with dt^2).
struct InterfaceStiffness {
  double per_step = 0, fixed = 0;
};

/// Returns true if a body of shape matching alone is pulled by springs, vessels or a membrane: what pulls at the interface of
/// others pulls at all of its nodes then.
bool is_linked(const Model& model, const FlsmBatch& b) { return b.interface == 0 && !model.links.empty(); }

InterfaceStiffness interface_stiffness(const Model& model) {
  InterfaceStiffness largest;
  for (const FlsmBatch& b : model.flsm) {
    if (is_linked(model, b)) {
      if (b.settings.young > 0)
        largest.fixed = std::max(largest.fixed, b.stiffest * spring_of(b));
      else
        largest.per_step =
            std::max(largest.per_step, b.stiffest * b.settings.alpha / (b.settings.substeps * b.settings.substeps));
    }
    if (b.interface == 0) continue;
    if (b.settings.beta == 0 && b.settings.young > 0) {
      largest.fixed = std::max(largest.fixed, pull_bound(b) * spring_of(b));
      continue;
    }
    if (b.settings.beta == 0) {
      largest.per_step =
          std::max(largest.per_step, pull_bound(b) * b.settings.alpha / (b.settings.substeps * b.settings.substeps));
      continue;
    }
    largest.fixed = std::max(largest.fixed, pull_bound(b) * b.settings.beta / least_place_mass(model, b));
  }
  return largest;
}

/// The largest stable alpha = beta H^2 / m of an interface with held goals, for the step h and 2 / omega_max of the elements
/// in `elements`. Held goals act once in n steps, n times as hard, as an impulse. Between two impulses the phase of a mode
/// advances by n phi with sin(phi / 2) = h omega / 2. The trace of one period is 2 cos(n phi) - (alpha / n) sin(n phi) /
/// sin(phi), which stays above -2 while (alpha / n) tan(n phi / 2) <= 2 sin(phi). Just below n phi = pi each impulse meets a
/// mode after half a period: the resonance of multiple time steps (Biesiadecki and Skeel 1993). For n = 1 this is h^2 omega^2
/// + alpha <= 4.
double largest_held_alpha(int n, double h, double elements) {
  const double phi = 2 * std::asin(std::min(1.0, h / elements));
  return n * phi < M_PI ? 2 * n * std::sin(phi) / std::tan(0.5 * n * phi) : 0;
}

/// The longest stable step of a batch with held goals: the required alpha grows with the step, and the largest stable one
/// decreases.
double held_step(const FlsmBatch& b, const Model& model, double elements) {
  const DeformationModel& m = b.settings;
  double fixed = m.young > 0 ? spring_of(b) : 0;  // alpha = fixed H^2
  if (m.beta > 0) fixed = m.beta / least_place_mass(model, b);
  double low = 0, high = elements;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), h = m.substeps * middle;
    const double alpha = b.stiffest_interface * (fixed > 0 ? fixed * h * h : m.alpha);
    (alpha <= largest_held_alpha(m.substeps, middle, elements) ? low : high) = middle;
  }
  return low;
}

}  // namespace

bool has_elements(const Model& model) { return !model.links.empty() || has_finite_elements(model); }

bool has_finite_elements(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const ModelBody& b) { return b.operational_elements > 0; });
}

double longest_step(const Model& model, const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const FlsmBatch& b : model.flsm) {
    const double damping = scene.bodies[static_cast<std::size_t>(b.body)].material.damping;
    least = std::min(least, automatic_matching_step(b, damping, extrapolates(b)) / b.settings.substeps);
  }
  return least;
}

double coupled_step(const Model& model, double elements_alone) {
  const InterfaceStiffness k = interface_stiffness(model);
  const double omega2 = 4 / (elements_alone * elements_alone) + k.fixed;
  return std::min(std::sqrt((4 - k.per_step) / omega2), held_goals_step(model, elements_alone));
}

double held_goals_step(const Model& model, double elements_alone) {
  double step = std::numeric_limits<double>::infinity();
  for (const FlsmBatch& b : model.flsm) {
    if (b.interface > 0 && b.settings.substeps > 1 && !b.settings.extrapolate)
      step = std::min(step, held_step(b, model, elements_alone));
  }
  return step;
}

std::vector<double> interface_springs(const Model& model, double dt) {
  std::vector<double> spring;
  for (const FlsmBatch& b : model.flsm) {
    if (b.interface == 0 && !is_linked(model, b)) continue;
    spring.resize(model.mass.size(), 0.0);
    const DeformationModel& m = b.settings;
    const double h = m.substeps * dt, automatic = m.young > 0 ? spring_of(b) : m.alpha / (h * h);
    for (std::int32_t i = 0; i < b.own && is_linked(model, b); ++i)
      spring[static_cast<std::size_t>(b.slot[i])] = b.stiffest * automatic;
    const std::vector<double> masses = m.beta > 0 ? place_masses(model, b) : std::vector<double>();
    for (std::int32_t k = 0; k < b.interface; ++k) {
      spring[static_cast<std::size_t>(b.slot[b.own + k])] = pull_bound(b) * (m.beta > 0 ? m.beta / masses[k] : automatic);
    }
  }
  return spring;
}

namespace {

/// The largest stable beta of a batch at the step `dt` [N/m], by bisection to 0.2 % between `bound`, which needs no
/// iteration, and the given value.
double largest_beta(const RunContext& run, const FlsmBatch& batch, double dt, double bound) {
  const std::vector<double> given = interface_springs(run.model(), dt);
  double low = bound, high = batch.settings.beta;
  while (low > 0 && high > 1.002 * low) {
    const double middle = std::sqrt(low * high);
    std::vector<double> spring = given;
    for (std::int32_t i = batch.own; i < batch.own + batch.interface; ++i) {
      spring[static_cast<std::size_t>(batch.slot[i])] *= middle / batch.settings.beta;
    }
    (dt * dt * largest_omega2(run, spring) <= 4 ? low : high) = middle;
  }
  return low;
}

}  // namespace

void check_beta(const RunContext& run, double dt, double elements_dt) {
  const Model& model = run.model();
  const double stable_dt = run.state.limit.stable_dt;
  const InterfaceStiffness k = interface_stiffness(model);
  if (k.fixed == 0 || stable_dt <= 0 || elements_dt <= 0 || dt <= stable_dt) return;
  for (const FlsmBatch& b : model.flsm) {
    if (b.settings.beta == 0 || b.interface == 0) continue;
    const double mass = least_place_mass(model, b);
    const double omega2 = 4 / (elements_dt * elements_dt);
    double most = largest_beta(run, b, dt, mass * ((4 - k.per_step) / (dt * dt) - omega2) / pull_bound(b));
    if (b.settings.substeps > 1 && !b.settings.extrapolate) {
      const double h = b.settings.substeps * dt;
      most = std::min(
          most, mass * largest_held_alpha(b.settings.substeps, dt, 2 / std::sqrt(omega2)) / (h * h * b.stiffest_interface));
    }
    throw Error(
        ErrorCode::bad_input,
        fmt::format("{}/beta: got {} N/m, which is beyond stability at dt = {} s; allowed is at most {}, or dt up to {:.6g} s",
                    b.settings.pointer, b.settings.beta, dt,
                    most > 0 ? fmt::format("{:.6g} N/m", most) : "none (dt is too large for the elements already)", stable_dt));
  }
}

double matching_modulus(const FlsmBatch& batch, double dt, double damping) {
  return alpha_for(batch, dt, 0, damping) * stiffness_unit(batch) / step_square(batch.settings.substeps * dt, damping);
}

void upload_coupling(const RunContext& run) {
  const Model& model = run.model();
  if (model.flsm.empty()) return;
  const Program& program = run.loaded.program();
  std::vector<double> alpha;
  for (std::size_t i = 0; i < model.flsm.size(); ++i) {
    const FlsmBatch& b = model.flsm[i];
    const double dt = run.state.clock.dt, h = b.settings.substeps * dt;
    const double damping = run.scene.bodies[static_cast<std::size_t>(b.body)].material.damping;
    const double at_rest = alpha_for(b, dt, run.settings.first_dt, damping, run.settings.automatic);
    // The damping of dynamic relaxation reduces b; alpha is adapted so that the pull towards the goals, alpha m / b, does not
    // change.
    alpha.push_back(at_rest * (step_square(h, damping + run.state.relaxation.damping) / step_square(h, damping)));
    if (b.interface == 0) continue;
    const BufferId id = program.find(fmt::format("flsm_beta/{}", i));
    std::vector<double> beta(program.at(id).count, 0.0);
    const std::vector<double> masses = b.settings.beta > 0 ? place_masses(model, b) : std::vector<double>();
    for (std::int32_t k = 0; k < b.interface; ++k) {
      const double own = model.mass[static_cast<std::size_t>(b.slot[b.own + k])];
      // With a "stiffness", use the spring of the own nodes, alpha m / b, regardless of the damping: both ends pull alike at
      // rest.
      const double automatic = b.settings.young > 0 ? at_rest / step_square(h, damping) : at_rest / (h * h);
      const auto node = static_cast<std::size_t>(b.own + k);
      const double pulled = b.settings.young > 0 ? b.weight[node] * b.regions.holders[node] : own;
      const double mean = b.settings.beta > 0 ? b.settings.beta * (own / masses[k]) : automatic * pulled;
      beta[k] = pull_factor(b.settings) * mean;
    }
    run.backend().write_reals(id, beta);
    const BufferId mean = program.find(fmt::format("flsm_mean_beta/{}", i));
    if (mean < 0) continue;
    for (double& k : beta) k /= pull_factor(b.settings);
    run.backend().write_reals(mean, beta);
  }
  run.backend().write_reals(program.find("flsm_alpha"), alpha);
}

namespace {

/// Calls f(id of the buffer, values) for the extrapolated goals of each batch: [interface][2][4], the nodes where they are.
template <class F>
void for_each_start(const Model& model, const std::vector<double>& u, const Program& program, const F& f) {
  for (std::size_t i = 0; i < model.flsm.size(); ++i) {
    const FlsmBatch& b = model.flsm[i];
    if (!extrapolates(b)) continue;
    const BufferId id = program.find(fmt::format("flsm_goals/{}", i));
    std::vector<double> goals(program.at(id).values());
    for (std::int32_t k = 0; k < b.interface; ++k)
      std::copy_n(&u[4 * static_cast<std::size_t>(b.slot[b.own + k])], 3, &goals[8 * static_cast<std::size_t>(k)]);
    f(id, std::move(goals));
  }
}

}  // namespace

void start_goals(const Model& model, const std::vector<double>& u, Program& program) {
  for_each_start(model, u, program, [&](BufferId id, std::vector<double> goals) { program.at(id).reals = std::move(goals); });
}

void start_goals(const RunContext& run) {
  for_each_start(run.model(), run.loaded.u(), run.loaded.program(),
                 [&](BufferId id, const std::vector<double>& goals) { run.backend().write_reals(id, goals); });
}

}  // namespace pliant
