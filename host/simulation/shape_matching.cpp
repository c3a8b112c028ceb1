// What shape matching asks of the host: its stiffness for the present step, the step that its interface allows, and its longer
// steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "pliant/error.h"
#include "simulation/simulation.h"

namespace pliant {
namespace {

constexpr double kFrame = 1.0 / 60;  ///< automatic step of a scene without finite elements [s]

/// How many times its beta the interface feels while it feels any: see flsm_interface in program_flsm.cpp.
int strokes(const DeformationModel& m) { return m.extrapolate ? 1 : m.substeps; }

/// Young's modulus of shape matching is E = c rho d^2 alpha / b, with b = H^2 / (1 + D H / 2) for the step H and the damping
/// rate D [1/s]. c by half-width, minus one: the uniaxial pull of bars of any thickness, which is (w^2 + w) / 3, the variance
/// of a window of 2 w + 1 nodes. Measured by bench/calibrate.py; bending is stiffer where regions are thicker than the body
/// (docs/flsm_stiffness.md).
constexpr double kPullStiffness[] = {2.0 / 3, 2, 4, 20.0 / 3, 10};

/// E b / alpha [Pa s^2]: what a batch's stiffness is in proportion to.
double stiffness_unit(const FlsmBatch& batch) {
  return kPullStiffness[batch.settings.width - 1] * batch.density * batch.spacing * batch.spacing;
}

/// The step of the scene at which alpha is 1, the longest that "stiffness" allows [s].
double longest_step(const FlsmBatch& batch, double damping) {
  const DeformationModel& m = batch.settings;
  if (m.young <= 0) return std::numeric_limits<double>::infinity();
  const double b = stiffness_unit(batch) / m.young, quarter = 0.25 * damping * b;
  return (quarter + std::sqrt(quarter * quarter + b)) / m.substeps;
}

double longest_step(const Model& model, const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const FlsmBatch& b : model.flsm) {
    least = std::min(least, longest_step(b, scene.bodies[static_cast<std::size_t>(b.body)].material.damping));
  }
  return least;
}

/// The alpha of a batch at the step `dt` of the scene [s], for the damping rate of its material [1/s]: as it stands in the
/// scene, or from "stiffness". It falls with the step: what a start allows, every smaller step allows. Throws Error above 1.
double alpha_for(const FlsmBatch& batch, double dt, double damping) {
  const DeformationModel& m = batch.settings;
  if (m.young <= 0) return m.alpha;
  const double h = m.substeps * dt, b = h * h / (1 + 0.5 * damping * h), most = stiffness_unit(batch) / b;
  if (m.young > 1.00001 * most) {  // the message's digits are allowed
    throw Error(ErrorCode::bad_input,
                fmt::format("{}/stiffness/young: got {} Pa, which no alpha reaches with width {} at dt = {:.6g} s{}; allowed "
                            "is at most {:.6g} Pa, "
                            "or dt up to {:.6g} s",
                            m.pointer, m.young, m.width, dt, m.substeps > 1 ? fmt::format(" and {} substeps", m.substeps) : "",
                            most, longest_step(batch, damping)));
  }
  return std::min(1.0, m.young / most);
}

/// The mass at the place of each interface node [kg]: its own, or that of all its copies where a cut has divided it. A given
/// beta belongs to the place; the copies share it like their mass, or a cut would stiffen the lighter ones.
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

/// beta over mass that a batch adds to omega^2 of its interface nodes, as a multiple of 1 / dt^2 (automatic) and as a number
/// [1/s^2] (given, or automatic with an alpha that falls with dt^2).
struct InterfaceStiffness {
  double per_step = 0, fixed = 0;
};

InterfaceStiffness interface_stiffness(const Model& model) {
  InterfaceStiffness largest;
  for (const FlsmBatch& b : model.flsm) {
    if (b.interface == 0) continue;
    if (b.settings.beta == 0 && b.settings.young > 0) {
      largest.fixed = std::max(largest.fixed, strokes(b.settings) * b.settings.young / stiffness_unit(b));
      continue;
    }
    if (b.settings.beta == 0) {
      largest.per_step =
          std::max(largest.per_step, strokes(b.settings) * b.settings.alpha / (b.settings.substeps * b.settings.substeps));
      continue;
    }
    largest.fixed = std::max(largest.fixed, strokes(b.settings) * b.settings.beta / least_place_mass(model, b));
  }
  return largest;
}

/// The largest alpha = beta H^2 / m that an interface with held goals stands, where h is the step and 2 / omega_max of the
/// elements is `elements`. Held goals pull once in n steps, n times as hard: an impulse. Between two pulls a mode turns by n
/// phi with sin(phi / 2) = h omega / 2; one period has the trace 2 cos(n phi) - (alpha / n) sin(n phi) / sin(phi), which stays
/// above -2 while (alpha / n) tan(n phi / 2) <= 2 sin(phi). Just below n phi = pi every pull pushes a mode that has turned half
/// a circle: the resonance of multiple time steps (Biesiadecki and Skeel 1993). For n = 1 this is h^2 omega^2 + alpha <= 4.
double largest_held_alpha(int n, double h, double elements) {
  const double phi = 2 * std::asin(std::min(1.0, h / elements));
  return n * phi < M_PI ? 2 * n * std::sin(phi) / std::tan(0.5 * n * phi) : 0;
}

/// The longest step that a batch of held goals stands: what its pull takes grows with the step, what is left for it shrinks.
double held_step(const FlsmBatch& b, const Model& model, double elements) {
  const DeformationModel& m = b.settings;
  double fixed = m.young > 0 ? m.young / stiffness_unit(b) : 0;  // alpha = fixed H^2
  if (m.beta > 0) fixed = m.beta / least_place_mass(model, b);
  double low = 0, high = elements;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), h = m.substeps * middle;
    const double alpha = fixed > 0 ? fixed * h * h : m.alpha;
    (alpha <= largest_held_alpha(m.substeps, middle, elements) ? low : high) = middle;
  }
  return low;
}

}  // namespace

bool Simulation::has_elements() const {
  return std::any_of(model_->bodies.begin(), model_->bodies.end(),
                     [](const ModelBody& b) { return b.operational_elements > 0; });
}

/// A bound without an iteration: the spring beta between an interface node and its goal adds beta / m to omega^2 at most. With
/// beta = alpha m / H^2, H = n h: h^2 (omega^2 + alpha / (n h)^2) <= 4. Held goals pull n times as hard in one substep of n,
/// and resonate.
double Simulation::coupled_step(double elements_alone) const {
  const InterfaceStiffness k = interface_stiffness(*model_);
  const double omega2 = 4 / (elements_alone * elements_alone) + k.fixed;
  return std::min(std::sqrt((4 - k.per_step) / omega2), held_goals_step(elements_alone));
}

/// The longest step that held goals stand [s].
double Simulation::held_goals_step(double elements_alone) const {
  double step = std::numeric_limits<double>::infinity();
  for (const FlsmBatch& b : model_->flsm) {
    if (b.interface > 0 && b.settings.substeps > 1 && !b.settings.extrapolate)
      step = std::min(step, held_step(b, *model_, elements_alone));
  }
  return step;
}

/// What the springs between interface nodes and their goals add to omega^2 at most, at the step `dt` [s], per slot [1/s^2];
/// empty without an interface.
std::vector<double> Simulation::interface_springs(double dt) const {
  std::vector<double> spring;
  for (const FlsmBatch& b : model_->flsm) {
    if (b.interface == 0) continue;
    spring.resize(model_->mass.size(), 0.0);
    const DeformationModel& m = b.settings;
    const double h = m.substeps * dt, automatic = m.young > 0 ? m.young / stiffness_unit(b) : m.alpha / (h * h);
    const std::vector<double> masses = m.beta > 0 ? place_masses(*model_, b) : std::vector<double>();
    for (std::int32_t k = 0; k < b.interface; ++k) {
      spring[static_cast<std::size_t>(b.slot[b.own + k])] = strokes(m) * (m.beta > 0 ? m.beta / masses[k] : automatic);
    }
  }
  return spring;
}

/// The largest beta of a batch that the step `dt` stands [N/m], between what a bound without an iteration allows and what is
/// given, to 0.2 %.
double Simulation::largest_beta(const FlsmBatch& batch, double dt, double bound) {
  const std::vector<double> given = interface_springs(dt);
  double low = bound, high = batch.settings.beta;
  while (low > 0 && high > 1.002 * low) {
    const double middle = std::sqrt(low * high);
    std::vector<double> spring = given;
    for (std::int32_t i = batch.own; i < batch.own + batch.interface; ++i) {
      spring[static_cast<std::size_t>(batch.slot[i])] *= middle / batch.settings.beta;
    }
    (dt * dt * largest_omega2(spring) <= 4 ? low : high) = middle;
  }
  return low;
}

/// An automatic step is short enough for the alpha that "stiffness" asks for; a given one is refused by alpha_for.
void Simulation::choose_dt(double wanted, bool estimate) {
  const double longest = longest_step(*model_, scene_);
  if (!has_elements()) {
    state_.dt = wanted > 0 ? wanted : std::min(kFrame, longest);
    automatic_ = false;
    return;
  }
  if (wanted <= 0 || estimate) estimate_stable_dt();
  state_.dt = wanted > 0 ? wanted : std::min(scene_.safety * state_.stable_dt, longest);
  // Every cut leaves elements that are stable at the element bound: each copy's mass and stiffness scale alike.
  if (wanted <= 0 && !scene_.blades.empty()) {
    state_.dt = std::min(state_.dt, scene_.safety * coupled_step(model_->element_bound));
  }
  const InterfaceStiffness k = interface_stiffness(*model_);
  if (wanted <= 0 || k.fixed == 0 || state_.stable_dt <= 0 || elements_dt_ <= 0 || wanted <= state_.stable_dt) return;
  for (const FlsmBatch& b : model_->flsm) {
    if (b.settings.beta == 0 || b.interface == 0) continue;
    const double mass = least_place_mass(*model_, b);
    const double omega2 = 4 / (elements_dt_ * elements_dt_);
    double most = largest_beta(b, wanted, mass * ((4 - k.per_step) / (wanted * wanted) - omega2) / strokes(b.settings));
    if (b.settings.substeps > 1 && !b.settings.extrapolate) {
      const double h = b.settings.substeps * wanted;
      most = std::min(most, mass * largest_held_alpha(b.settings.substeps, wanted, 2 / std::sqrt(omega2)) / (h * h));
    }
    throw Error(
        ErrorCode::bad_input,
        fmt::format("{}/beta: got {} N/m, which is beyond stability at dt = {} s; allowed is at most {}, or dt up to {:.6g} s",
                    b.settings.pointer, b.settings.beta, wanted,
                    most > 0 ? fmt::format("{:.6g} N/m", most) : "none (dt is too large for the elements already)",
                    state_.stable_dt));
  }
}

std::int32_t Simulation::substeps_of(std::size_t slot) const {
  for (const FlsmBatch& b : model_->flsm) {
    if (static_cast<std::int64_t>(slot) >= b.first_slot && static_cast<std::int64_t>(slot) < b.first_slot + b.slots)
      return b.settings.substeps;
  }
  return 1;
}

std::int64_t Simulation::period() const {
  std::int64_t period = 1;
  for (const FlsmBatch& b : model_->flsm) period = std::lcm(period, std::int64_t{b.settings.substeps});
  return period;
}

bool Simulation::begins_after(std::int64_t step, std::int64_t every) const {
  const std::int64_t p = period();
  return step % p == 0 && step % every < p;
}

void Simulation::restore(const SimulationState& state) {
  state_ = state;
  upload_shape_matching();  // the automatic beta belongs to the step
}

void Simulation::upload_shape_matching() {
  if (model_->flsm.empty()) return;
  std::vector<double> alpha;
  for (std::size_t i = 0; i < model_->flsm.size(); ++i) {
    const FlsmBatch& b = model_->flsm[i];
    const double h = b.settings.substeps * state_.dt;
    alpha.push_back(alpha_for(b, state_.dt, scene_.bodies[static_cast<std::size_t>(b.body)].material.damping));
    if (b.interface == 0) continue;
    const BufferId id = program_.find(fmt::format("flsm_beta/{}", i));
    std::vector<double> beta(program_.buffers[static_cast<std::size_t>(id)].count, 0.0);
    const std::vector<double> masses = b.settings.beta > 0 ? place_masses(*model_, b) : std::vector<double>();
    for (std::int32_t k = 0; k < b.interface; ++k) {
      const double own = model_->mass[static_cast<std::size_t>(b.slot[b.own + k])];
      const double mean = b.settings.beta > 0 ? b.settings.beta * (own / masses[k]) : alpha.back() * own / (h * h);
      beta[k] = strokes(b.settings) * mean;
    }
    backend_->write_reals(id, beta);
    const BufferId mean = program_.find(fmt::format("flsm_mean_beta/{}", i));
    if (mean < 0) continue;
    for (double& k : beta) k /= strokes(b.settings);
    backend_->write_reals(mean, beta);
  }
  backend_->write_reals(program_.find("flsm_alpha"), alpha);
}

}  // namespace pliant
