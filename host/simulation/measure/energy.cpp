#include "simulation/measure/energy.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "material/response.h"
#include "model/elements/each_element.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector_of(const Vec3d& a) { return {a[0], a[1], a[2]}; }
Vec3d array_of(const Vector3d& a) { return {a[0], a[1], a[2]}; }

double density(const Matrix3d& h, const Material& m) {
  const double dilation = Kinematics(h).j;
  return energy_without_volume(m, h) + volume_modulus(m) / 2 * dilation * dilation;
}

/// Of all elements, or of those whose slots are all `chosen`.
Energies internal(const Model& model, const std::vector<Vec3d>& u, const std::vector<char>* chosen) {
  struct Shares {
    double rest = 0, deformed = 0;  ///< per node: shares of its elements' volumes
  };
  std::map<std::pair<const Material*, std::int32_t>, Shares> nodal;  // by batch and slot
  Energies out;
  const auto displacement = [&](std::int32_t slot) { return vector_of(u[slot]); };
  for_each_element(model, [&](const ElementView& e) {
    const auto counts = [&](std::int32_t slot) { return chosen == nullptr || (*chosen)[slot] != 0; };
    if (!std::all_of(e.slots.begin(), e.slots.end(), counts)) return;
    for_each_point(e, displacement, [&](const auto& gradients, double weight, const auto& corners) {
      const Matrix3d h = corners * gradients;
      if (!element_info(e.kind).averaged) {
        out.strain += weight * density(h, e.material);
        return;
      }
      out.strain += weight * energy_without_volume(e.material, h);
      const double share = weight / static_cast<double>(e.slots.size());
      for (const std::int32_t n : e.slots) {
        Shares& at = nodal[{&e.material, n}];
        at.rest += share;
        at.deformed += share * (1 + Kinematics(h).j);
      }
    });
    out.hourglass += hourglass_energy(e, displacement);
  });
  for (const auto& [at, volume] : nodal) {
    const double dilation = volume.deformed / volume.rest - 1;
    out.strain += volume.rest * volume_modulus(*at.first) / 2 * dilation * dilation;
  }
  return out;
}

/// Whether all slots of a point of links are `chosen`.
bool point_counts(const LinkPoints& points, std::int32_t p, const std::vector<char>* chosen) {
  for (std::size_t a = 0; a < 8; ++a) {
    if (points.weights[p][a] != 0 && chosen != nullptr && (*chosen)[points.slots[p][a]] == 0) return false;
  }
  return true;
}

double membrane_energy(const Model& model, const std::vector<Vec3d>& u, const std::vector<char>* chosen) {
  const LinkPoints& points = model.links.points;
  const auto moved = [&](std::int32_t slot) { return u[slot]; };
  double sum = 0;
  for (const MembraneBatch& b : model.links.membranes) {
    for (std::size_t t = 0; t < b.size(); ++t) {
      const auto counts = [&](std::int32_t p) { return point_counts(points, p, chosen); };
      if (!std::all_of(b.points[t].begin(), b.points[t].end(), counts)) continue;
      Membrane::Corners corners{};
      for (std::size_t a = 0; a < 3; ++a) corners[a] = points.value(b.points[t][a], moved);
      sum += b.law.energy(b.records[t], corners);
    }
  }
  return sum;
}

/// Potential energy of springs, or of those between slots that are all `chosen` [J].
double spring_energy(const Model& model, const std::vector<Vec3d>& u, const std::vector<char>* chosen) {
  const LinkPoints& points = model.links.points;
  const auto counts = [&](std::int32_t p) { return point_counts(points, p, chosen); };
  const auto moved = [&](std::int32_t slot) { return u[slot]; };
  double sum = 0;
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      const auto [from, to] = b.points[s];
      if (!b.whole(s) || !counts(from) || !counts(to)) continue;
      sum += spring_state(b.law, b.parameters[s], elongation(points, b, s, moved)).energy;
    }
  }
  return sum;
}

}  // namespace

Energies energies_among(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v,
                        const std::vector<char>& chosen) {
  Energies out = internal(model, u, &chosen);
  out.strain += spring_energy(model, u, &chosen) + membrane_energy(model, u, &chosen);
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    if (chosen[s] != 0) out.kinetic += model.mass[s] / 2 * vector_of(v[s]).squaredNorm();
  }
  return out;
}

Energies energies(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v, const DeadLoads& loads) {
  Energies out = internal(model, u, nullptr);
  out.strain += spring_energy(model, u, nullptr) + membrane_energy(model, u, nullptr);
  const Vector3d gravity = vector_of(loads.gravity);
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    if (!(model.mass[s] > 0)) continue;
    out.kinetic += model.mass[s] / 2 * vector_of(v[s]).squaredNorm();
    out.external -= model.mass[s] * gravity.dot(vector_of(u[s]));
  }
  for (const NodeForce& f : model.forces) {
    out.external -= model.curves[f.curve].value(loads.time) * vector_of(f.force).dot(vector_of(u[f.slot]));
  }
  return out;
}

Momenta momenta(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v) {
  double mass = 0;
  Vector3d centre = Vector3d::Zero(), linear = Vector3d::Zero(), angular = Vector3d::Zero();
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    if (!(model.mass[s] > 0)) continue;
    const Vector3d x = vector_of(model.rest[s]) + vector_of(u[s]), p = model.mass[s] * vector_of(v[s]);
    mass += model.mass[s];
    centre += model.mass[s] * x;
    linear += p;
    angular += x.cross(p);
  }
  return {mass, array_of(centre / mass), array_of(linear), array_of(angular)};
}

std::vector<Vec3d> by_slot(const Model& model, const std::vector<std::vector<Vec3d>>& bodies) {
  std::vector<Vec3d> out(model.slots);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t n = 0; n < bodies[b].size(); ++n) out[model.bodies[b].slot[n]] = bodies[b][n];
  }
  return out;
}

}  // namespace pliant
