// Dynamic relaxation: damping that follows the lowest mode still moving.
#include <algorithm>
#include <cmath>

#include "simulation/simulation.h"

namespace pliant {

/// Dynamic relaxation: damp the lowest mode that still moves critically, c = 2 omega with omega^2 = - du . df / (du . M du)
/// from the change of displacement and force since the last look (Papadrakakis 1981; Joldes, Wittek and Miller 2009).
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
