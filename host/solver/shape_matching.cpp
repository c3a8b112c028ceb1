// What shape matching asks of the host: its stiffness for the present step, the step that its interface allows, and its longer
// steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pliant/error.h"
#include "solver/simulation.h"

namespace pliant {
namespace {

constexpr double kFrame = 1.0 / 60;  ///< automatic step of a scene without finite elements [s]

/// How many times its beta the interface feels while it feels any: see flsm_interface in program_flsm.cpp.
int strokes(const DeformationModel& m) { return m.extrapolate ? 1 : m.substeps; }

/// beta over mass that a batch adds to omega^2 of its interface nodes, as a multiple of 1 / dt^2 (automatic) and as a number
/// [1/s^2].
struct InterfaceStiffness {
  double per_step = 0, fixed = 0;
};

InterfaceStiffness interface_stiffness(const Model& model) {
  InterfaceStiffness largest;
  for (const FlsmBatch& b : model.flsm) {
    if (b.interface == 0) continue;
    if (b.settings.beta == 0) {
      largest.per_step =
          std::max(largest.per_step, strokes(b.settings) * b.settings.alpha / (b.settings.substeps * b.settings.substeps));
      continue;
    }
    for (std::int32_t i = b.own; i < b.own + b.interface; ++i) {
      largest.fixed = std::max(largest.fixed, strokes(b.settings) * b.settings.beta / model.mass[b.slot[i]]);
    }
  }
  return largest;
}

}  // namespace

bool Simulation::has_elements() const {
  return std::any_of(model_->bodies.begin(), model_->bodies.end(),
                     [](const ModelBody& b) { return b.operational_elements > 0; });
}

/// The spring beta between an interface node and its goal adds beta / m to omega^2 at most, for the goal follows the node. With
/// beta = alpha m / H^2, H = n h: h^2 (omega^2 + alpha / (n h)^2) <= 4. Held goals pull n times as hard in one substep of n.
double Simulation::coupled_step(double elements_alone) const {
  const InterfaceStiffness k = interface_stiffness(*model_);
  const double omega2 = 4 / (elements_alone * elements_alone) + k.fixed;
  return std::sqrt((4 - k.per_step) / omega2);
}

void Simulation::choose_dt(double wanted, bool estimate) {
  if (!has_elements()) {
    state_.dt = wanted > 0 ? wanted : kFrame;
    automatic_ = false;
    return;
  }
  if (wanted <= 0 || estimate) estimate_stable_dt();
  state_.dt = wanted > 0 ? wanted : scene_.safety * state_.stable_dt;
  const InterfaceStiffness k = interface_stiffness(*model_);
  if (wanted <= 0 || k.fixed == 0 || state_.stable_dt <= 0 || wanted <= state_.stable_dt) return;
  for (const FlsmBatch& b : model_->flsm) {
    if (b.settings.beta == 0 || b.interface == 0) continue;
    double mass = std::numeric_limits<double>::infinity();
    for (std::int32_t i = b.own; i < b.own + b.interface; ++i) mass = std::min(mass, model_->mass[b.slot[i]]);
    const double omega2 = (4 - k.per_step) / (state_.stable_dt * state_.stable_dt) - k.fixed;
    const double most = mass * ((4 - k.per_step) / (wanted * wanted) - omega2) / strokes(b.settings);
    throw Error(fmt::format(
        "{}/beta: got {} N/m, which is beyond stability at dt = {} s; allowed is at most {}, or dt up to {:.6g} s",
        b.settings.pointer, b.settings.beta, wanted,
        most > 0 ? fmt::format("{:.6g} N/m", most) : "none (dt is too large for the elements already)", state_.stable_dt));
  }
}

std::int32_t Simulation::substeps_of(std::size_t slot) const {
  for (const FlsmBatch& b : model_->flsm) {
    if (static_cast<std::int64_t>(slot) >= b.first_slot && static_cast<std::int64_t>(slot) < b.first_slot + b.slots)
      return b.settings.substeps;
  }
  return 1;
}

/// Steps since the start, as far as subcycling needs them.
std::int64_t Simulation::phase() const {
  std::int64_t period = 1;
  for (const FlsmBatch& b : model_->flsm) period = std::lcm(period, std::int64_t{b.settings.substeps});
  return state_.step % period;
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
    alpha.push_back(b.settings.alpha);
    if (b.interface == 0) continue;
    const BufferId id = program_.find(fmt::format("flsm_beta/{}", i));
    std::vector<double> beta(program_.buffers[static_cast<std::size_t>(id)].count, 0.0);
    for (std::int32_t k = 0; k < b.interface; ++k) {
      const double mean = b.settings.beta > 0 ? b.settings.beta : b.settings.alpha * model_->mass[b.slot[b.own + k]] / (h * h);
      beta[k] = strokes(b.settings) * mean;
    }
    backend_->write_reals(id, beta);
  }
  backend_->write_reals(program_.find("flsm_alpha"), alpha);
}

}  // namespace pliant
