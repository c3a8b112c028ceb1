// Decomposition and removal: blades divide elements into smaller ones, or elements go. New nodes move as the edges do that
// they divide, so that no element feels the edit; what goes takes its mass and energy along, which is written down.
#include <cmath>
#include <utility>
#include <vector>

#include "simulation/edits/model_swap.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/measure/energy.h"

namespace pliant {
namespace {

double mass_of(const Model& model) {
  double mass = 0;
  for (const ModelBody& body : model.bodies) mass += body.mass;
  return mass;
}

/// Kinetic energy, strain energy and potential of dead loads [J].
double energy_of(const RunContext& run) {
  const Model& model = run.model();
  const std::vector<double> all_u = run.u(), increments = run.increments();
  std::vector<Vec3d> u(model.mass.size()), v(model.mass.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<Vec3d> velocity = run.velocities(increments, b);
    for (std::size_t n = 0; n < velocity.size(); ++n) {
      const auto slot = static_cast<std::size_t>(model.bodies[b].slot[n]);
      v[slot] = velocity[n];
      for (std::size_t c = 0; c < 3; ++c) u[slot][c] = all_u[4 * slot + c];
    }
  }
  const double now = run.state.clock.time();
  return energies(model, u, v, {run.scene.gravity_at(now), now}).total();
}

}  // namespace

void TopologyEdits::remake(std::vector<CutEdges> crossed, std::vector<double> u, CutReport& report) {
  EditedBodies& all = bodies();
  const bool removes = blade_method(run_.scene) == BladeMethod::removal;
  const double energy = removes ? energy_of(run_) : 0, mass = mass_of(run_.model());
  const std::int64_t elements = run_.model().elements();
  std::vector<char> changed = swap_bodies(
      [&](std::size_t b) { return crossed[b].empty() ? NodeOrigins{} : all.remake(b, crossed[b]); }, std::move(u), report);
  if (!report.changed) return;
  for (std::size_t b = 0; b < crossed.size(); ++b) {
    if (crossed[b].empty()) continue;
    all.follow(b, run_.state);
    report.in_part += all.remade(b)->cut_in_part();
    run_.state.cuts.push_back({static_cast<std::int32_t>(b), std::move(crossed[b])});
  }
  report.elements = run_.model().elements() - elements;
  RemadeElements& sums = run_.state.remade;
  if (removes) {
    report.mass_lost = mass - mass_of(run_.model());
    sums.mass += report.mass_lost;
    const double lost = energy - energy_of(run_);
    if (std::isfinite(lost)) sums.energy += lost;  // an element that is inside out may have no energy
  }
  sums.elements += report.elements;
  if (sums.edits++ == 0) sums.first_step = run_.state.clock.dt;
  end_edit(std::move(changed), report);
}

}  // namespace pliant
