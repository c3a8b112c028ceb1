#include "simulation/measure/energies_now.h"

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "simulation/state/run_context.h"

namespace pliant {
namespace {

/// The acceleration of a node in the next step. Contact is impulsive: what it did in the last step it does again only where it
/// balances the other forces.
Vec3d acceleration(const Vec3d& others, const Vec3d& contact) {
  const Vec3d both = vec::add(others, contact);
  return vec::norm(both) < vec::norm(others) ? both : others;
}

/// Kinetic energy as the integrator defines it. `before`: velocities of the last step by slot [m/s].
double kinetic(const RunContext& run, const std::vector<Vec3d>& before, const std::vector<Vec3d>& contact) {
  const Model& m = run.model();
  const std::vector<double> forces = run.forces_now();
  std::vector<std::vector<Vec3d>> by_body(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) by_body[b] = run.loaded.pick(forces, b, 1);
  const std::vector<Vec3d> force = by_slot(m, by_body);
  std::vector<std::int32_t> held(m.mass.size());
  for (const Constraint& c : m.constraints) held[static_cast<std::size_t>(c.slot)] = c.axes;
  const auto square = integrator_info(run.scene.integrator).squared_velocity;
  const Vec3d gravity = run.scene.gravity_at(run.state.clock.time());
  double sum = 0;
  for (std::size_t slot = 0; slot < m.mass.size(); ++slot) {
    if (!(m.mass[slot] > 0)) continue;
    const double h = substeps_of(m, slot) * run.state.clock.dt, k = m.damping[slot] * h / 2;
    Vec3d a = vec::add(vec::mul(force[slot], 1 / m.mass[slot]), gravity);
    if (!contact.empty()) a = acceleration(a, vec::mul(contact[slot], 1 / m.mass[slot]));
    for (std::size_t c = 0; c < 3; ++c) {
      if ((held[slot] >> c & 1) != 0) continue;
      sum += m.mass[slot] / 2 * square(before[slot][c], a[c], h, k);
    }
  }
  return sum;
}

}  // namespace

Energies energies_now(const RunContext& run, const std::vector<Vec3d>& contact) {
  const Model& m = run.model();
  const std::vector<double> all = run.u(), increments = run.increments();
  std::vector<std::vector<Vec3d>> u(m.bodies.size()), v(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    u[b] = run.loaded.pick(all, b, 1);
    v[b] = run.velocities(increments, b);
  }
  const double time = run.state.clock.time();
  const std::vector<Vec3d> velocity = by_slot(m, v);
  Energies now = energies(m, by_slot(m, u), velocity, {run.scene.gravity_at(time), time});
  now.kinetic = kinetic(run, velocity, contact);
  return now;
}

}  // namespace pliant
