#include "model/ballast.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "material/response.h"
#include "model/boundary_conditions.h"
#include "model/each_hex.h"
#include "model/eigenvalues.h"
#include "model/hourglass.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kReserve = 1.5;  ///< times what is needed now
constexpr double kTooMuch = 2;    ///< times that again is given back

/// Largest eigenvalue of the tangent of a point with N nodes, rows of `b`: K = w B^T C B with C = dP/dF, hence at most
/// w lambda_max(C) lambda_max(sum_a grad N_a grad N_a^T).
template <int N>
double point_stiffness(const Eigen::Matrix<double, N, 3>& b, const Eigen::Matrix<double, 3, N>& u, double weight,
                       const Material& material, bool quick) {
  Response response;
  if (!respond(material, u * b, true, response)) return 0;
  const Matrix9d tangent = 0.5 * (response.tangent + response.tangent.transpose());
  const Matrix3d gram = b.transpose() * b;
  Eigen::SelfAdjointEigenSolver<Matrix3d> size(gram, Eigen::EigenvaluesOnly);
  const double largest = quick ? tangent.norm() : largest_eigenvalue(tangent);
  return weight * std::max(0.0, largest) * size.eigenvalues()[2];
}

Vector3d displacement(const std::vector<double>& u, std::int32_t slot) {
  return Eigen::Map<const Vector3d>(u.data() + 4 * static_cast<std::size_t>(slot));
}

double hex_stiffness(const HexView& view, const std::vector<double>& u, bool quick) {
  Eigen::Matrix<double, 3, 8> moved;
  for (int a = 0; a < 8; ++a) moved.col(a) = displacement(u, view.slots[a]);
  const auto gradients = [&](int at) -> Eigen::Matrix<double, 8, 3> {
    return Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(view.record.data() + at);
  };
  double sum = 0;
  if (view.full) {
    for (int g = 0; g < 8; ++g) {
      sum += point_stiffness<8>(gradients(25 * g), moved, view.fill * view.record[25 * g + 24], view.material, quick);
    }
    return sum;
  }
  return point_stiffness<8>(gradients(0), moved, view.fill * hex8_volume(view.record), view.material, quick) +
         view.fill * hourglass_bound(view.record, moved);
}

double tet_stiffness(const TetBatch& batch, std::size_t e, const std::vector<double>& u, bool quick) {
  Eigen::Matrix<double, 4, 3> b;
  b.row(0).setZero();
  Eigen::Matrix<double, 3, 4> moved;
  for (int a = 0; a < 4; ++a) {
    moved.col(a) = displacement(u, batch.nodes[e][a]);
    if (a == 0) continue;
    b.row(a) = Eigen::Map<const Eigen::RowVector3d>(batch.gradients[e].data() + 3 * (a - 1));
    b.row(0) -= b.row(a);
  }
  return point_stiffness<4>(b, moved, batch.volume[e], batch.material, quick);
}

}  // namespace

void set_ballast(const Scene& scene, Model& model, std::span<const NodeInertia> ballast) {
  for (const Ballast& b : model.ballast) {
    model.mass[b.slot] = b.mass;
    model.added[b.slot] = b.added;
  }
  model.ballast.clear();
  if (!ballast.empty()) model.added.resize(model.mass.size());
  for (const NodeInertia& b : ballast) {
    model.ballast.push_back({b, model.mass[b.slot], model.added[b.slot]});
    model.mass[b.slot] += b.inertia;
    model.added[b.slot] += b.inertia;
  }
  add_boundary_conditions(scene, model);
}

std::vector<double> nodal_stiffness(const Model& model, const std::vector<double>& u, const std::vector<char>& wanted,
                                    bool quick) {
  std::vector<double> sum(model.mass.size());
  const auto asked = [&](std::int32_t slot) { return wanted.empty() || wanted[slot] != 0; };
  const auto add = [&](const auto& slots, const auto& stiffness_of) {
    if (std::none_of(slots.begin(), slots.end(), asked)) return;
    const double stiffness = stiffness_of();
    for (const std::int32_t s : slots) {
      if (asked(s)) sum[s] += stiffness;
    }
  };
  for (const TetBatch& batch : model.tets) {
    for (std::size_t e = 0; e < batch.nodes.size(); ++e) add(batch.nodes[e], [&] { return tet_stiffness(batch, e, u, quick); });
  }
  for_each_hex(model, [&](const HexView& view) { add(view.slots, [&] { return hex_stiffness(view, u, quick); }); });
  return sum;
}

double stiffness_bound(const Model& model, const std::vector<double>& stiffness) {
  double most = 0;
  for (std::size_t s = 0; s < stiffness.size(); ++s) {
    if (model.mass[s] > 0) most = std::max(most, stiffness[s] / model.mass[s]);
  }
  return most > 0 ? 2 / std::sqrt(most) : 0;
}

std::vector<NodeInertia> wanted_ballast(const Model& model, const std::vector<double>& stiffness, double dt) {
  std::vector<NodeInertia> out;
  auto now = model.ballast.begin();
  for (std::size_t s = 0; s < stiffness.size(); ++s) {
    const bool has = now != model.ballast.end() && static_cast<std::size_t>(now->slot) == s;
    double inertia = has ? now->inertia : 0;
    const double own = has ? now->mass : model.mass[s], needed = stiffness[s] * dt * dt / 4;
    if (has) ++now;
    if (!(own > 0) || !std::isfinite(needed)) continue;
    if (needed > own + inertia || kTooMuch * kReserve * needed < own + inertia) {
      inertia = needed > own ? kReserve * needed - own : 0;
    }
    if (inertia > 0) out.push_back({static_cast<std::int32_t>(s), inertia});
  }
  return out;
}

}  // namespace pliant
