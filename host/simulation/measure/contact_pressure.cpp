#include "simulation/measure/contact_pressure.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// Displacements of all slots [m].
std::vector<Vec3d> displacements_by_slot(const Simulation& simulation) {
  const Model& model = simulation.model();
  std::vector<Vec3d> u(static_cast<std::size_t>(model.slots) + 1, Vec3d{});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<Vec3d> own = simulation.displacements(b);
    for (std::size_t n = 0; n < own.size(); ++n) u[static_cast<std::size_t>(model.bodies[b].slot[n])] = own[n];
  }
  return u;
}

/// The deformed outward unit normal of a contact point.
Vec3d normal_of(const Model& model, std::size_t point, const std::vector<Vec3d>& u) {
  ContactTangents t = contact_tangents(*model.contact, point, model.rest);
  for (std::size_t a = 0; a < 8; ++a) {
    const Vec3d& moved = u[static_cast<std::size_t>(model.contact->nodes[point][a])];
    t.t1 = vec::add(t.t1, vec::mul(moved, t.first[a]));
    t.t2 = vec::add(t.t2, vec::mul(moved, t.second[a]));
  }
  const Vec3d normal = vec::cross(t.t1, t.t2);
  const double length = vec::norm(normal);
  return length > 0 ? vec::mul(normal, 1 / length) : Vec3d{};
}

}  // namespace

std::vector<float> contact_pressures(const Simulation& simulation) {
  const Model& model = simulation.model();
  const ModelSurface& surface = model.surface;
  std::vector<float> out(surface.rest.size(), 0);
  const std::vector<Vec3d> force = simulation.contact().point_forces();
  if (force.empty()) return out;
  const ContactPoints& points = *model.contact;
  const std::vector<Vec3d> u = displacements_by_slot(simulation);
  std::vector<double> pushed(static_cast<std::size_t>(model.slots) + 1, 0.0), area = pushed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double inward = force[i] == Vec3d{} ? 0 : std::max(0.0, -vec::dot(force[i], normal_of(model, i, u)));
    for (std::size_t a = 0; a < 8; ++a) {
      const double share = double(points.weights[i][a]) / contact_weight_unit;
      pushed[static_cast<std::size_t>(points.nodes[i][a])] += share * inward;
      area[static_cast<std::size_t>(points.nodes[i][a])] += share * points.area[i];
    }
  }
  for (std::size_t v = 0; v < out.size(); ++v) {
    double sum = 0, over = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      const auto slot = static_cast<std::size_t>(surface.nodes[v][a]);
      sum += surface.weights[v][a] * pushed[slot];
      over += surface.weights[v][a] * area[slot];
    }
    out[v] = over > 0 ? static_cast<float>(sum / over) : 0;
  }
  return out;
}

}  // namespace pliant
