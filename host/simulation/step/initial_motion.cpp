#include "simulation/step/initial_motion.h"

#include <vector>

#include "integrators/integrator.h"

namespace pliant {

void set_initial_motion(const RunContext& run) {
  const Model& m = run.model();
  const std::vector<double> force = run.forces_now();
  std::vector<double> w(4 * static_cast<std::size_t>(m.slots));
  const Vec3d gravity = run.scene.gravity_at(run.state.clock.time());
  const auto first = integrator_info(run.scene.integrator).first;
  const std::vector<double> u = run.loaded.u();
  for (std::size_t s = 0; s < m.mass.size(); ++s) {
    const double h = substeps_of(m, s) * run.state.clock.dt;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!run.loaded.free()[3 * s + c]) continue;
      const double a = force[4 * s + c] / m.mass[s] + gravity[c] - m.damping[s] * m.velocity[s][c];
      w[4 * s + c] = first({u[4 * s + c], m.velocity[s][c], a, h});
    }
    w[4 * s + 3] = run.decay(m, s);
  }
  run.loaded.write_w(w);
}

}  // namespace pliant
