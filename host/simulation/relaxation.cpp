#include "simulation/relaxation.h"

#include <algorithm>
#include <cmath>

namespace pliant {

void relax(RunContext& run) {
  const Model& model = run.model();
  RelaxationState& relaxation = run.state.relaxation;
  const std::vector<double> u = run.loaded.u();
  const std::vector<double> force = run.forces_now();
  std::vector<double>&old_u = relaxation.u, &old_force = relaxation.force;
  double stiffness = 0, inertia = 0, residual = 0, external = 0, reaction = 0;
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    const double m = model.mass[s];
    if (!(m > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t t = 4 * s + c;
      const double weight = m * run.scene.gravity[c];
      if (!run.loaded.free()[3 * s + c]) {
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
  for (const NodeForce& f : model.forces) {
    for (const double component : f.force) external += component * component;
  }
  if (stiffness > 0 && inertia > 0) {
    const double material = *std::max_element(model.damping.begin(), model.damping.end());
    relaxation.damping = std::max(0.0, 2 * std::sqrt(stiffness / inertia) - material);
    run.upload_decay();
  }
  const double scale = std::sqrt(std::max(external, reaction));
  relaxation.residual = scale > 0 ? std::sqrt(residual) / scale : (residual > 0 ? 1 : 0);
  relaxation.equilibrium =
      run.state.clock.time() >= run.settings.curves_end && relaxation.residual <= run.scene.relaxation.tolerance;
  old_u = u;
  old_force = force;
}

}  // namespace pliant
