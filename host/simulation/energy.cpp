#include "simulation/energy.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "material/response.h"
#include "model/each_hex.h"
#include "model/hourglass.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Gradients8 = Eigen::Matrix<double, 8, 3>;
using RowMajor8 = Eigen::Matrix<double, 8, 3, Eigen::RowMajor>;

Vector3d vector_of(const Vec3d& a) { return {a[0], a[1], a[2]}; }
Vec3d array_of(const Vector3d& a) { return {a[0], a[1], a[2]}; }

double density(const Matrix3d& h, const Material& m) {
  const double dilation = Kinematics(h).j;
  return energy_without_volume(m, h) + volume_modulus(m) / 2 * dilation * dilation;
}

class Sum {
 public:
  /// `chosen`: slots between which elements count; null: all.
  Sum(const std::vector<Vec3d>& u, const std::vector<char>* chosen) : u_(u), chosen_(chosen) {}

  void tets(const TetBatch& batch) {
    std::map<std::int32_t, std::array<double, 2>> nodal;  // a quarter of the volumes, rest and deformed
    for (std::size_t e = 0; e < batch.nodes.size(); ++e) {
      const auto& nodes = batch.nodes[e];
      if (!counts(nodes)) continue;
      Matrix3d h = Matrix3d::Zero();
      for (int a = 0; a < 3; ++a) {
        const Eigen::Map<const Vector3d> gradient(batch.gradients[e].data() + 3 * a);
        h += (displacement(nodes[a + 1]) - displacement(nodes[0])) * gradient.transpose();
      }
      const double volume = batch.volume[e];
      if (!batch.averaged) {
        out.strain += volume * density(h, batch.material);
        continue;
      }
      out.strain += volume * energy_without_volume(batch.material, h);
      for (const std::int32_t n : nodes) {
        nodal[n][0] += volume / 4;
        nodal[n][1] += volume / 4 * (1 + Kinematics(h).j);
      }
    }
    for (const auto& [node, volume] : nodal) {
      const double dilation = volume[1] / volume[0] - 1;
      out.strain += volume[0] * volume_modulus(batch.material) / 2 * dilation * dilation;
    }
  }

  void hex(const HexView& view) {
    if (!counts(view.slots)) return;
    if (!view.full) {
      point(view.slots, view.record.data(), view.fill * hex8_volume(view.record), view.material);
      out.hourglass += view.fill * hourglass_energy(view.record, gather(view.slots));
      return;
    }
    for (int g = 0; g < 8; ++g)
      point(view.slots, view.record.data() + 25 * g, view.fill * view.record[25 * g + 24], view.material);
  }

  Energies out;

 private:
  template <std::size_t N>
  [[nodiscard]] bool counts(const std::array<std::int32_t, N>& nodes) const {
    return chosen_ == nullptr ||
           std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t slot) { return (*chosen_)[slot] != 0; });
  }
  [[nodiscard]] Vector3d displacement(std::int32_t slot) const { return vector_of(u_[slot]); }

  [[nodiscard]] Displacements8 gather(const std::array<std::int32_t, 8>& nodes) const {
    Displacements8 u;
    for (int a = 0; a < 8; ++a) u.col(a) = displacement(nodes[a]);
    return u;
  }

  void point(const std::array<std::int32_t, 8>& nodes, const double* gradients, double weight, const Material& material) {
    const Gradients8 b = Eigen::Map<const RowMajor8>(gradients);
    const Matrix3d h = gather(nodes) * b;
    out.strain += weight * density(h, material);
  }

  const std::vector<Vec3d>& u_;
  const std::vector<char>* chosen_;
};

Energies internal(const Model& model, const std::vector<Vec3d>& u, const std::vector<char>* chosen) {
  Sum sum(u, chosen);
  for (const TetBatch& batch : model.tets) sum.tets(batch);
  for_each_hex(model, [&](const HexView& view) { sum.hex(view); });
  return sum.out;
}

}  // namespace

Energies energies_among(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v,
                        const std::vector<char>& chosen) {
  Energies out = internal(model, u, &chosen);
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    if (chosen[s] != 0) out.kinetic += model.mass[s] / 2 * vector_of(v[s]).squaredNorm();
  }
  return out;
}

Energies energies(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v, const DeadLoads& loads) {
  Energies out = internal(model, u, nullptr);
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
