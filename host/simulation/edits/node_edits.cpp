#include "simulation/edits/node_edits.h"

#include <fmt/format.h>

#include <cmath>

#include "integrators/integrator.h"
#include "pliant/error.h"

namespace pliant {
namespace {

void check(const ModelBody& body, const std::vector<Vec3d>& values, const char* what) {
  const std::size_t nodes = body.slot.size();
  if (!values.empty() && values.size() != nodes) {
    throw Error(ErrorCode::usage,
                fmt::format("the state of body '{}' has {} {} for {} nodes; they are given for all nodes, in the order of "
                            "rest_positions(), which are not the vertices of a frame",
                            body.name, values.size(), what, nodes));
  }
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Vec3d& v = values[n];
    if (std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2])) continue;
    throw Error(ErrorCode::usage,
                fmt::format("the state of body '{}' has at node {} of its {} the numbers {}, {}, {}; they must "
                            "be finite",
                            body.name, n, what, v[0], v[1], v[2]));
  }
}

/// What node_w holds for an increment h v at a displacement: the inverse of IntegratorInfo::increment, which is linear in w.
double stored(const IntegratorInfo& info, double u, double increment) {
  const double sign = std::round(info.increment(0, 1));
  return (increment - info.increment(u, 0)) * sign;  // the factor of w is 1 or -1
}

}  // namespace

void set_nodes(RunContext& run, std::size_t body, const std::vector<Vec3d>& displacements,
               const std::vector<Vec3d>& velocities) {
  const ModelBody& of = run.model().bodies.at(body);
  check(of, displacements, "displacements");
  check(of, velocities, "velocities");
  const IntegratorInfo& info = integrator_info(run.scene.integrator);
  std::vector<double> u = run.u(), w = run.loaded.w();
  const std::vector<double> before = run.loaded.u(), h_v = run.increments();
  const std::vector<char>& is_free = run.loaded.free();
  for (std::size_t n = 0; n < of.slot.size(); ++n) {
    const auto slot = static_cast<std::size_t>(of.slot[n]);
    const double h = substeps_of(run.model(), slot) * run.state.clock.dt;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t t = 4 * slot + c;
      if (!is_free[3 * slot + c]) continue;
      const double moved = displacements.empty() ? 0 : displacements[n][c] - u[t];
      const double increment = velocities.empty() ? h_v[t] : h * velocities[n][c];
      if (!displacements.empty()) u[t] = displacements[n][c];
      if (!velocities.empty() || !info.keeps_increment) w[t] = stored(info, before[t] + moved, increment);
    }
  }
  if (!displacements.empty()) run.write_u(std::move(u));
  run.loaded.write_w(w);
}

}  // namespace pliant
