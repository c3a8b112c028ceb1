#include "model/nodes/ballast.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "elements/eigenvalues.h"
#include "material/response.h"
#include "model/elements/each_element.h"
#include "model/links/membranes.h"
#include "model/nodes/boundary_conditions.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kReserve = 1.5;  ///< new ballast relative to the need
constexpr double kTooMuch = 2;    ///< ballast of more than this times the need is reduced

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

/// Adds for each spring twice the larger of its slope and of force over length, which are the eigenvalues of its tangent.
void add_link_stiffness(const Model& model, const std::vector<double>& u, const std::vector<char>& wanted,
                        std::vector<double>& sum) {
  const LinkPoints& points = model.links.points;
  const auto moved = [&](std::int32_t slot) {
    const double* at = u.data() + 4 * static_cast<std::size_t>(slot);
    return Vec3d{at[0], at[1], at[2]};
  };
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      if (!b.whole(s)) continue;
      const double e = elongation(points, b, s, moved), length = std::max(b.length[s] + e, 1e-30);
      const SpringState state = spring_state(b.law, b.parameters[s], e);
      const double stiffness = std::max({state.slope, state.force / length, rest_stiffness(b, s)});
      for_each_share(points, b, s, [&](std::int32_t slot, double share) {
        if (wanted.empty() || wanted[slot] != 0) sum[slot] += share * stiffness;
      });
    }
  }
}

double element_stiffness(const ElementView& e, const std::vector<double>& u, bool quick) {
  const auto moved = [&](std::int32_t slot) { return displacement(u, slot); };
  double sum = 0;
  for_each_point(e, moved, [&](const auto& gradients, double weight, const auto& corners) {
    sum += point_stiffness(gradients, corners, weight, e.material, quick);
  });
  return sum + hourglass_bound(e, moved);
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
  for_each_element(model, [&](const ElementView& e) {
    if (std::none_of(e.slots.begin(), e.slots.end(), asked)) return;
    const double stiffness = element_stiffness(e, u, quick);
    for (const std::int32_t s : e.slots) {
      if (asked(s)) sum[s] += stiffness;
    }
  });
  add_link_stiffness(model, u, wanted, sum);
  add_membrane_stiffness(model, &u, sum);
  return sum;
}

double stiffness_bound(const Model& model, const std::vector<double>& stiffness) {
  const std::size_t s = stiffest_node(model, stiffness);
  return s < stiffness.size() && stiffness[s] > 0 ? 2 / std::sqrt(stiffness[s] / model.mass[s]) : 0;
}

std::size_t stiffest_node(const Model& model, const std::vector<double>& stiffness) {
  std::size_t at = 0;
  double most = 0;
  for (std::size_t s = 0; s < stiffness.size(); ++s) {
    if (!(model.mass[s] > 0) || !(stiffness[s] / model.mass[s] > most)) continue;
    most = stiffness[s] / model.mass[s];
    at = s;
  }
  return at;
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
