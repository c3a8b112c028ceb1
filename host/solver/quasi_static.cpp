// What looks at forces on the host between batches: the stable step by power iteration, and dynamic relaxation.
#include <algorithm>
#include <cmath>

#include "solver/simulation.h"

namespace pliant {
namespace {

constexpr double kStrain = 1e-3;  ///< size of the probing displacement over the shortest element

/// A start vector with a share of every mode, the same for every run.
double noise(std::size_t i) {
  std::uint64_t z = (i + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

}  // namespace

/// omega_max^2 = lim |M^-1 K v| / |v| in the norm of M, with K v from a difference of two force evaluations on the backend itself:
/// every element, law and constraint is in it, at the present deformation.
double Simulation::estimate_stable_dt(int iterations) {
  const auto slots = static_cast<std::size_t>(model_->slots);
  const std::vector<double> u = backend_->read_reals(u_);
  const std::vector<double> rest_force = forces_now();
  std::vector<double>& v = state_.vectors["power"];
  if (v.size() != 3 * slots) {
    v.assign(3 * slots, 0);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = free_[i] ? noise(i) : 0;
  }
  std::vector<double> probe = u;
  double omega2 = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    double largest = 0;
    for (const double x : v) largest = std::max(largest, std::abs(x));
    if (!(largest > 0) || !std::isfinite(largest)) break;
    const double scale = kStrain * model_->shortest / largest;
    double norm = 0, next_norm = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] *= scale;
      probe[4 * (i / 3) + i % 3] = u[4 * (i / 3) + i % 3] + v[i];
      norm += model_->mass[i / 3] * v[i] * v[i];
    }
    backend_->write_reals(u_, probe);
    backend_->run(program_.force, 0, 1);
    const std::vector<double> force = backend_->read_reals(force_);
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!free_[i]) continue;
      const std::size_t t = 4 * (i / 3) + i % 3;
      v[i] = (rest_force[t] - force[t]) / model_->mass[i / 3];
      next_norm += model_->mass[i / 3] * v[i] * v[i];
    }
    const double before = omega2;
    omega2 = std::sqrt(next_norm / norm);
    if (iteration > 4 && std::abs(omega2 - before) < 1e-5 * omega2) break;
  }
  backend_->write_reals(u_, u);
  // The iteration approaches omega_max from below: one percent is kept back for what it has not reached.
  state_.stable_dt = omega2 > 0 ? 2 / std::sqrt(omega2) / 1.01 : 0;
  return state_.stable_dt;
}

/// Dynamic relaxation: damp the lowest mode that still moves critically, c = 2 omega with omega^2 = - du . df / (du . M du) from the
/// change of displacement and force since the last look (Papadrakakis 1981; Joldes, Wittek and Miller 2009).
void Simulation::relax() {
  const std::vector<double> u = backend_->read_reals(u_);
  const std::vector<double> force = forces_now();
  std::vector<double>& old_u = state_.vectors["relax_u"];
  std::vector<double>& old_force = state_.vectors["relax_force"];
  double stiffness = 0, inertia = 0, residual = 0, external = 0, reaction = 0;
  for (std::size_t s = 0; s < model_->mass.size(); ++s) {
    const double m = model_->mass[s];
    if (!(m > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t t = 4 * s + c;
      const double weight = m * scene_.gravity[c];
      if (!free_[3 * s + c]) {
        reaction += force[t] * force[t];
        continue;
      }
      residual += (force[t] + weight) * (force[t] + weight);
      external += weight * weight;
      if (!old_u.empty()) {
        const double du = u[t] - old_u[t];
        stiffness -= du * (force[t] - old_force[t]);
        inertia += m * du * du;
      }
    }
  }
  for (const NodeForce& f : model_->forces) {
    for (const double component : f.force) external += component * component;
  }
  if (stiffness > 0 && inertia > 0) {
    const double material = *std::max_element(model_->damping.begin(), model_->damping.end());
    state_.damping = std::max(0.0, 2 * std::sqrt(stiffness / inertia) - material);
    upload_decay();
  }
  const double scale = std::sqrt(std::max(external, reaction));
  residual_ = scale > 0 ? std::sqrt(residual) / scale : (residual > 0 ? 1 : 0);
  equilibrium_ = time() >= curves_end_ && residual_ <= scene_.relaxation.tolerance;
  old_u = u;
  old_force = force;
}

}  // namespace pliant
