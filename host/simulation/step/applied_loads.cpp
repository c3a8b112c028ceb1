#include "simulation/step/applied_loads.h"

#include "geometry/vec.h"

namespace pliant {

namespace {

/// Adds the pressures on the deformed surface, by slot.
void add_pressures(const Model& model, const std::vector<Vec3d>& u, double time, std::vector<Vec3d>& out) {
  const ModelSurface& surface = model.surface;
  const auto position = [&](std::int32_t v) {
    Vec3d x = surface.rest[v];
    for (std::size_t a = 0; a < 8; ++a)
      x = vec::add(x, vec::mul(u[static_cast<std::size_t>(surface.nodes[v][a])], surface.weights[v][a]));
    return x;
  };
  for (const TrianglePressure& p : model.pressures) {
    const auto& triangle = surface.triangles[p.triangle];
    const Vec3d x0 = position(triangle[0]), x1 = position(triangle[1]), x2 = position(triangle[2]);
    const double pressure = model.curves[p.curve].value(time) * p.pressure;
    const Vec3d third = vec::mul(vec::cross(vec::sub(x1, x0), vec::sub(x2, x0)), -pressure / 6);
    for (const std::int32_t v : triangle) {
      for (std::size_t a = 0; a < 8; ++a) {
        Vec3d& node = out[static_cast<std::size_t>(surface.nodes[v][a])];
        node = vec::add(node, vec::mul(third, surface.weights[v][a]));
      }
    }
  }
}

}  // namespace

std::vector<Vec3d> applied_loads(const Simulation& simulation, std::size_t body) {
  const Model& model = simulation.model();
  const double time = simulation.time();
  std::vector<Vec3d> u(static_cast<std::size_t>(model.slots)), load(u.size());
  for (std::size_t b = 0; b < model.bodies.size() && !model.pressures.empty(); ++b) {
    const std::vector<Vec3d> of_body = simulation.displacements(b);
    for (std::size_t n = 0; n < of_body.size(); ++n) u[model.bodies[b].slot[n]] = of_body[n];
  }
  // The Model contains forces that cancel the weight of added inertia.
  const Vec3d gravity = simulation.scene().gravity_at(time);
  for (std::size_t s = 0; s < load.size(); ++s) load[s] = vec::mul(gravity, model.mass[s]);
  for (const NodeForce& f : model.forces)
    load[f.slot] = vec::add(load[f.slot], vec::mul(f.force, model.curves[f.curve].value(time)));
  add_pressures(model, u, time, load);
  for (const HostForce& f : simulation.state().forces) {
    const auto& slots = model.bodies[f.body].slot;
    if (f.node >= static_cast<std::int64_t>(slots.size())) continue;
    Vec3d& node = load[slots[static_cast<std::size_t>(f.node)]];
    node = vec::add(node, f.force);
  }
  std::vector<Vec3d> out;
  for (const std::int32_t slot : model.bodies.at(body).slot) out.push_back(load[static_cast<std::size_t>(slot)]);
  return out;
}

}  // namespace pliant
