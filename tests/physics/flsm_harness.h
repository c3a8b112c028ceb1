// Bodies that follow shape matching, and what the tests of FLSM and hybrids measure on them.
#pragma once
#include <algorithm>
#include <deque>
#include <map>

#include "physics/harness.h"

namespace pliant::physics {

/// A box of lattice cells that follows `type`; a hybrid has finite elements below x = `split` [m].
inline Body matched_box(const Box& box, ModelType type, double split = 0, ElementKind element = ElementKind::hex8) {
  Body body = box_body(box, Discretization::hex8_bricks, material_young(Law::neo_hookean, 3000, 0.3));
  body.name = to_string(type);
  body.element = element;
  body.model.type = type;
  body.model.pointer = "/bodies/0/model";
  if (type == ModelType::hybrid) {
    Selection region;
    region.kind = Selection::Kind::box;
    region.a = {-1, -1, -1};
    region.b = {split, 1, 1};
    region.pointer = "/bodies/0/model/region";
    body.model.region = region;
  }
  return body;
}

/// Displacements and increments over the step of each node's model, as velocities, by slot.
inline std::vector<Vec3d> velocities_of(const Simulation& sim) {
  std::vector<std::vector<Vec3d>> bodies;
  for (std::size_t b = 0; b < sim.model().bodies.size(); ++b) bodies.push_back(sim.velocities(b));
  return by_slot(sim.model(), bodies);
}
inline Momenta momenta_now(const Simulation& sim) {
  return momenta(sim.model(), read_texels(sim, "node_u"), velocities_of(sim));
}
/// About the centre of mass.
inline Vector3d spin_of(const Momenta& m) { return eigen(m.angular) - eigen(m.centre).cross(eigen(m.linear)); }

/// The rotation nearest to `a`, by singular values in double.
inline Matrix3d nearest_rotation(const Matrix3d& a) {
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Weighted nodes at rest and now: the sum of m |T X - x|^2 at the best rigid T.
class Match {
 public:
  void add(double m, const Vector3d& rest, const Vector3d& now) { nodes_.push_back({m, rest, now}); }
  [[nodiscard]] double misfit() const {
    double mass = 0, sum = 0;
    Vector3d rest = Vector3d::Zero(), now = Vector3d::Zero();
    for (const Node& n : nodes_) {
      mass += n.mass;
      rest += n.mass * n.rest;
      now += n.mass * n.now;
    }
    rest /= mass;
    now /= mass;
    Matrix3d a = Matrix3d::Zero();
    for (const Node& n : nodes_) a += n.mass * (n.now - now) * (n.rest - rest).transpose();
    const Matrix3d r = nearest_rotation(a);
    for (const Node& n : nodes_) sum += n.mass * (r * (n.rest - rest) - (n.now - now)).squaredNorm();
    return sum;
  }
  [[nodiscard]] double mass() const {
    double mass = 0;
    for (const Node& n : nodes_) mass += n.mass;
    return mass;
  }

 private:
  struct Node {
    double mass;
    Vector3d rest, now;
  };
  std::vector<Node> nodes_;
};

/// Root mean square distance of the nodes of a batch from their rest shape, moved rigidly as a whole [m].
inline double shape_error(const Model& model, const FlsmBatch& batch, const std::vector<Vec3d>& u) {
  Match match;
  for (const std::int32_t s : batch.slot) match.add(model.mass[s], eigen(model.rest[s]), eigen(model.rest[s]) + eigen(u[s]));
  return std::sqrt(match.misfit() / match.mass());
}

/// The nodes of each region by breadth-first search along the links, inside the window.
inline std::vector<std::vector<std::int32_t>> regions_of(const Model& model, const FlsmBatch& batch) {
  const auto nodes = static_cast<std::int32_t>(batch.slot.size());
  const double reach = (batch.settings.width + 0.5) * batch.spacing;
  std::vector<std::vector<std::int32_t>> regions(batch.slot.size());
  for (std::int32_t r = 0; r < nodes; ++r) {
    std::vector<char> seen(batch.slot.size(), 0);
    std::deque<std::int32_t> front{r};
    seen[r] = 1;
    while (!front.empty()) {
      const std::int32_t n = front.front();
      front.pop_front();
      regions[r].push_back(n);
      for (const std::int32_t next : batch.link[n]) {
        if (next < 0 || next >= nodes || seen[next] != 0) continue;
        const Vector3d offset = eigen(model.rest[batch.slot[next]]) - eigen(model.rest[batch.slot[r]]);
        if (offset.cwiseAbs().maxCoeff() > reach) continue;
        seen[next] = 1;
        front.push_back(next);
      }
    }
  }
  return regions;
}

/// The potential whose gradient shape matching follows: with h_i the number of regions that hold node i and T_r the best rigid
/// transformation of region r for the weights m_i / h_i,
///   V = alpha / (2 H^2) sum_r sum_(i in r) (m_i / h_i) |T_r X_i - x_i|^2,   -dV/dx_i = alpha m_i / H^2 (g_i - x_i),
/// for T_r is the minimiser and does not count in the gradient. So v += alpha (g - x) / H, x += H v is symplectic Euler in V.
class MatchingEnergy {
 public:
  MatchingEnergy(const Model& model, const FlsmBatch& batch)
      : model_(model), batch_(batch), regions_(regions_of(model, batch)), holders_(batch.slot.size()) {
    for (const auto& region : regions_) {
      for (const std::int32_t n : region) holders_[n] += 1;
    }
  }
  /// u by slot; `step` is H [s].
  [[nodiscard]] double operator()(const std::vector<Vec3d>& u, double step) const {
    double sum = 0;
    for (const auto& region : regions_) {
      Match match;
      for (const std::int32_t n : region) {
        const std::int32_t s = batch_.slot[n];
        match.add(model_.mass[s] / holders_[n], eigen(model_.rest[s]), eigen(model_.rest[s]) + eigen(u[s]));
      }
      sum += match.misfit();
    }
    return batch_.settings.alpha / (2 * step * step) * sum;
  }

 private:
  const Model& model_;
  const FlsmBatch& batch_;
  std::vector<std::vector<std::int32_t>> regions_;
  std::vector<double> holders_;
};

inline bool all_finite(const std::vector<Vec3d>& u) {
  return std::all_of(u.begin(), u.end(), [](const Vec3d& x) { return eigen(x).allFinite(); });
}

}  // namespace pliant::physics
