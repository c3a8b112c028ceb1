#include "simulation/energy.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "layout.h"
#include "material/response.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Gradients8 = Eigen::Matrix<double, 8, 3>;
using Displacements8 = Eigen::Matrix<double, 3, 8>;
using RowMajor8 = Eigen::Matrix<double, 8, 3, Eigen::RowMajor>;

Vector3d vector_of(const Vec3d& a) { return {a[0], a[1], a[2]}; }
Vec3d array_of(const Vector3d& a) { return {a[0], a[1], a[2]}; }

double density(const Matrix3d& h, const Material& m) {
  const double dilation = Kinematics(h).j;
  return energy_without_volume(m, h) + volume_modulus(m) / 2 * dilation * dilation;
}

class Sum {
 public:
  Sum(const Model& model, const std::vector<Vec3d>& u) : model_(model), u_(u) {}

  void tets(const TetBatch& batch) {
    std::map<std::int32_t, std::array<double, 2>> nodal;  // a quarter of the volumes, rest and deformed
    for (std::size_t e = 0; e < batch.nodes.size(); ++e) {
      const auto& nodes = batch.nodes[e];
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

  void hexes(const HexBatch& batch) {
    for (std::size_t e = 0; e < batch.nodes.size(); ++e) {
      const std::vector<double>& record = batch.uniform ? batch.records[0] : batch.records[e];
      if (batch.full) {
        for (int g = 0; g < 8; ++g)
          point(batch.nodes[e], record.data() + 25 * g, batch.fill[e] * record[25 * g + 24], batch.material);
      } else {
        one_point(batch.nodes[e], record, batch.fill[e], batch.material);
      }
    }
  }

  void bricks(const BrickBatch& batch) {
    const double d = batch.spacing;
    std::array<Vec3d, 8> cube;
    for (int a = 0; a < 8; ++a) cube[a] = {d * (a & 1), d * (a >> 1 & 1), d * (a >> 2 & 1)};
    const std::vector<double> record = hex8_record(cube, batch.material, "lattice cell");
    for (std::int32_t slot = batch.first * PLIANT_BRICK_NODES; slot < (batch.first + batch.count) * PLIANT_BRICK_NODES;
         ++slot) {
      if (model_.brick_fill[slot] > 0) one_point(cell_corners(slot), record, model_.brick_fill[slot], batch.material);
    }
  }

  Energies out;

 private:
  [[nodiscard]] Vector3d displacement(std::int32_t slot) const { return vector_of(u_[slot]); }

  /// Slots of the corners of the brick cell whose low corner is `slot`.
  [[nodiscard]] std::array<std::int32_t, 8> cell_corners(std::int32_t slot) const {
    const std::int32_t brick = slot / PLIANT_BRICK_NODES, place = slot % PLIANT_BRICK_NODES;
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) {
      const int x = place % 16 + (a & 1), y = place / 16 % 4 + (a >> 1 & 1), z = place / 64 + (a >> 2 & 1);
      const int side = (x == 16 ? 1 : 0) + (y == 4 ? 2 : 0) + (z == 4 ? 4 : 0);
      const std::int32_t owner = model_.brick_neighbor[PLIANT_BRICK_NEIGHBORS * brick + side];
      corners[a] = owner * PLIANT_BRICK_NODES + x % 16 + 16 * (y % 4) + 64 * (z % 4);
    }
    return corners;
  }

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

  void one_point(const std::array<std::int32_t, 8>& nodes, const std::vector<double>& record, double fill,
                 const Material& material) {
    point(nodes, record.data(), fill * record[56], material);
    const Eigen::Map<const Eigen::Matrix<double, 4, 8, Eigen::RowMajor>> gamma(record.data() + 24);
    out.hourglass += fill * record[57] / 2 * (gamma * gather(nodes).transpose()).squaredNorm();
  }

  const Model& model_;
  const std::vector<Vec3d>& u_;
};

}  // namespace

Energies energies(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v, const DeadLoads& loads) {
  Sum sum(model, u);
  for (const TetBatch& batch : model.tets) sum.tets(batch);
  for (const HexBatch& batch : model.hexes) sum.hexes(batch);
  for (const BrickBatch& batch : model.brick_batches) sum.bricks(batch);
  Energies out = sum.out;
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
