// Decomposition and removal: blades divide elements into smaller ones, or elements go. New nodes move as the edges do that
// they divide, so that no element feels the edit; what goes takes its mass and energy along, which is written down.
#include <cmath>
#include <utility>
#include <vector>

#include "simulation/edits/model_swap.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/measure/energies_now.h"

namespace pliant {
namespace {

double mass_of(const Model& model) {
  double mass = 0;
  for (const ModelBody& body : model.bodies) mass += body.mass;
  return mass;
}

}  // namespace

void TopologyEdits::remake(std::vector<CutEdges> crossed, std::vector<double> u, CutReport& report) {
  EditedBodies& all = bodies();
  const bool removes = blade_method(run_.scene) == BladeMethod::removal;
  const double energy = removes ? energies_now(run_).total() : 0, mass = mass_of(run_.model());
  const std::int64_t elements = run_.model().elements();
  std::vector<char> changed = swap_bodies(
      [&](std::size_t b) { return crossed[b].empty() ? NodeOrigins{} : all.remake(b, crossed[b]); }, std::move(u), report);
  if (!report.changed) return;
  for (std::size_t b = 0; b < crossed.size(); ++b) {
    if (crossed[b].empty()) continue;
    all.follow(b, run_.state);
    report.in_part += all.remade(b)->cut_in_part(crossed[b]);
    run_.state.cuts.push_back({static_cast<std::int32_t>(b), std::move(crossed[b])});
  }
  report.elements = run_.model().elements() - elements;
  RemadeElements& sums = run_.state.remade;
  if (removes) {
    report.mass_lost = mass - mass_of(run_.model());
    sums.mass += report.mass_lost;
  }
  sums.elements += report.elements;
  if (sums.edits++ == 0) sums.first_step = run_.state.clock.dt;
  end_edit(std::move(changed), report);
  const double lost = removes ? energy - energies_now(run_).total() : 0;
  if (std::isfinite(lost)) sums.energy += lost;  // an element that is inside out may have no energy
}

}  // namespace pliant
