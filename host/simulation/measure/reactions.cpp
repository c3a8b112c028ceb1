#include "simulation/measure/reactions.h"

namespace pliant {

namespace {

/// Prescribed displacement of a component [m].
double prescribed_at(const Model& model, const Constraint& c, std::size_t axis, double time) {
  const auto curve = static_cast<std::size_t>(c.curve[axis]);
  double u = c.target[axis] * model.curves[curve].value(time);
  if ((c.turned >> axis & 1) != 0) u += c.sine[axis] * model.curves[curve + 1].value(time);
  return u;
}

}  // namespace

std::vector<Vec3d> reactions(Simulation& simulation, std::size_t body) {
  const Model& model = simulation.model();
  const std::vector<std::int32_t>& slots = model.bodies.at(body).slot;
  const std::vector<Vec3d> residual = simulation.residual_forces(body);
  std::vector<std::int32_t> node_of(static_cast<std::size_t>(model.slots), -1);
  for (std::size_t n = 0; n < slots.size(); ++n) node_of[static_cast<std::size_t>(slots[n])] = static_cast<std::int32_t>(n);
  const double t = simulation.time(), h = simulation.dt();
  const Vec3d gravity = simulation.scene().gravity_at(t);
  std::vector<Vec3d> out(slots.size());
  for (const Constraint& c : model.constraints) {
    const auto slot = static_cast<std::size_t>(c.slot);
    if (node_of[slot] < 0 || c.slot >= model.list_end) continue;
    const auto n = static_cast<std::size_t>(node_of[slot]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((c.axes >> axis & 1) == 0) continue;
      const double before = prescribed_at(model, c, axis, t - h), now = prescribed_at(model, c, axis, t),
                   after = prescribed_at(model, c, axis, t + h);
      const double v = (after - before) / (2 * h), a = (after - 2 * now + before) / (h * h);
      out[n][axis] = model.mass[slot] * (a + model.damping[slot] * v - gravity[axis]) - residual[n][axis];
    }
  }
  return out;
}

}  // namespace pliant
