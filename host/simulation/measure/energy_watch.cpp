// Detects energy that appears without a source.
#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "simulation/measure/energies_now.h"
#include "simulation/simulation.h"

namespace pliant {
namespace {

double last_change(const Scene& scene) {
  double last = 0;
  const auto add = [&](const Curve& curve) {
    if (curve.kind != Curve::Kind::constant) last = std::max(last, curve.end());
  };
  add(scene.gravity_curve);
  for (const Body& body : scene.bodies) {
    for (const Prescribed& p : body.prescribed) add(p.curve);
    for (const Force& f : body.forces) add(f.curve);
  }
  return last;
}

}  // namespace

void Simulation::watch_energy() {
  const Model& m = model();
  if (time() < last_change(scene_) || report().inversions.last > 0 || !m.flsm.empty()) return;
  const Energies now = energies_now(run_, contact_.node_forces());
  if (!std::isfinite(now.total())) return;
  // Tissue that presses on a tool stands in it, and when the tool withdraws it gives back what that took: at most half of force
  // times depth. Gripped points that are away from their places likewise.
  double work = report().tissue.work, stored = contact_.held_energy();
  for (const ToolHistory& tool : report().tools) {
    work += tool.work;
    stored += 0.5 * vec::norm(tool.now.force) * tool.now.depth;
  }
  for (const auto& blade : state_.pressed) work += blade.second.work;
  const double left = now.total() - work + state_.remade.energy;  // as if what was removed were still there
  EnergyHistory& seen = reports_.now.energy;
  seen.highest = std::max({seen.highest, now.kinetic + now.strain + now.hourglass, std::abs(work)});
  if (!seen.least || left + stored < *seen.least) seen.least = left + stored;
  seen.created = std::max(seen.created, left - *seen.least);
}

}  // namespace pliant
