// Detects energy that appears without a source.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/vec.h"
#include "simulation/measure/energy.h"
#include "simulation/simulation.h"
#include "simulation/state/run_context.h"

namespace pliant {
namespace {

/// Kinetic energy as the integrator defines it.
double kinetic(Simulation& s, const std::vector<Vec3d>& before) {
  const Model& m = s.model();
  std::vector<std::vector<Vec3d>> by_body(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) by_body[b] = s.residual_forces(b);
  const std::vector<Vec3d> force = by_slot(m, by_body);
  std::vector<std::int32_t> held(m.mass.size());
  for (const Constraint& c : m.constraints) held[static_cast<std::size_t>(c.slot)] = c.axes;
  const auto square = integrator_info(s.scene().integrator).squared_velocity;
  double sum = 0;
  for (std::size_t slot = 0; slot < m.mass.size(); ++slot) {
    if (!(m.mass[slot] > 0)) continue;
    const double h = substeps_of(m, slot) * s.dt(), k = m.damping[slot] * h / 2;
    for (std::size_t c = 0; c < 3; ++c) {
      if ((held[slot] >> c & 1) != 0) continue;
      const double v = before[slot][c], a = force[slot][c] / m.mass[slot] + s.scene().gravity_at(s.time())[c];
      sum += m.mass[slot] / 2 * square(v, a, h, k);
    }
  }
  return sum;
}

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
  std::vector<std::vector<Vec3d>> u(m.bodies.size()), v(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    u[b] = displacements(b);
    v[b] = velocities(b);
  }
  const std::vector<Vec3d> velocity = by_slot(m, v);
  Energies now = energies(m, by_slot(m, u), velocity, {scene_.gravity_at(time()), time()});
  now.kinetic = kinetic(*this, velocity);
  if (!std::isfinite(now.total())) return;
  // Tissue that presses on a tool stands in it, and when the tool withdraws it gives back what that took: at most half of force
  // times depth.
  double work = 0, stored = 0;
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
