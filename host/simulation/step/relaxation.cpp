#include "simulation/step/relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/step/coupling.h"

namespace pliant {
namespace {

constexpr double kExcited = 4;  ///< factor on the expected energy of fast motion from rounding
constexpr double kStandsOut =
    3;  ///< minimum ratio of elastic work of a change to that of the fast motion for the change to be reliable
constexpr double kInterval = 0.25;  ///< with shape matching: minimum time constants of the damping between two updates
constexpr double kLittle = 100;     ///< factor on the tolerance: forces of fast motion below this may be rounding
constexpr double kSettled = 10;  ///< time constants of the damping without a resolvable change after which the state is final

/// Sums over the free components since the last update of the damping.
struct Sums {
  double stiffness = 0;  ///< - du . df [J]
  double inertia = 0;    ///< du . M du [kg m^2]
  double fast = 0;  ///< w . M w [J], where w is the mean of both velocities minus du / time: motion faster than the interval
  double mean = 0;  ///< |mean force|^2 [N^2], from the change of momentum and the work of the damping
  double mean_noise = 0;                            ///< contribution of the fast motion to it
  double residual = 0, external = 0, reaction = 0;  ///< current |R - F|^2, |R|^2, |reaction|^2 [N^2]
  double size = 0;                                  ///< u . M u [kg m^2]
};

/// Velocity of motion faster than the time since the last update [m/s]: the mean of both velocities minus the mean over the
/// time, and minus the periodic motion of shape matching (has_rhythm).
double fast_velocity(const RelaxationState& last, const std::vector<double>& u, const std::vector<double>& v, double time,
                     std::size_t t) {
  return (v[t] + last.v[t]) / 2 - (u[t] - last.u[t]) / time - (last.steady.empty() ? 0 : last.steady[t]);
}

std::vector<double> velocities(const RunContext& run) {
  std::vector<double> v = run.increments();
  for (double& x : v) x /= run.state.clock.dt;
  for (const FlsmBatch& b : run.model().flsm) {
    const auto first = static_cast<std::size_t>(b.first_slot), slots = static_cast<std::size_t>(b.slots);
    for (std::size_t i = 4 * first; i < 4 * (first + slots); ++i) v[i] /= b.settings.substeps;
  }
  return v;
}

Sums sum(const RunContext& run, const std::vector<double>& u, const std::vector<double>& force, const std::vector<double>& v) {
  const Model& model = run.model();
  const RelaxationState& last = run.state.relaxation;
  const double time = run.state.clock.time() - last.time;
  const Vec3d gravity = run.scene.gravity_at(run.state.clock.time());
  Sums out;
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    const double m = model.mass[s];
    if (!(m > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t t = 4 * s + c;
      const double weight = m * gravity[c];
      if (!run.loaded.free()[3 * s + c]) {
        out.reaction += force[t] * force[t];
        continue;
      }
      out.residual += (force[t] + weight) * (force[t] + weight);
      out.external += weight * weight;
      out.size += m * u[t] * u[t];
      if (last.u.empty()) continue;
      const double du = u[t] - last.u[t];
      out.stiffness -= du * (force[t] - last.force[t]);
      out.inertia += m * du * du;
      const double fast = fast_velocity(last, u, v, time, t);
      out.fast += m * fast * fast;
      const double mean = m * (v[t] - last.v[t] + (model.damping[s] + last.damping) * du) / time;
      out.mean += mean * mean;
      out.mean_noise += 4 * m * fast * m * fast / (time * time);
    }
  }
  for (const NodeForce& f : model.forces) {
    for (const double component : f.force) out.external += component * component;
  }
  return out;
}

/// Returns true if the fast motion is at the level of rounding. Each step rounds u by at most a third of (eps u)^2 on
/// average, which is a random velocity that the damping c removes within 1 / (2 c h) steps.
bool only_rounding(const RunContext& run, const Sums& sums, double c) {
  const double h = run.state.clock.dt;
  const double eps = run.backend().info().real_bytes == 4 ? std::numeric_limits<float>::epsilon() / 2
                                                          : std::numeric_limits<double>::epsilon() / 2;
  return c > 0 && sums.fast * c * h * h * h <= kExcited * eps * eps * sums.size;
}

/// Time after which loads and tools are constant [s].
double loads_end(const RunContext& run) {
  double end = run.settings.curves_end;
  for (const auto& driven : run.state.driven) end = std::max(end, driven.second.back().end);
  return end;
}

/// The largest damping rate of the materials [1/s].
double material_damping(const RunContext& run) {
  return *std::max_element(run.model().damping.begin(), run.model().damping.end());
}

void remember(RunContext& run, const std::vector<double>& u, const std::vector<double>& force, const std::vector<double>& v) {
  RelaxationState& last = run.state.relaxation;
  last.u = u;
  last.force = force;
  last.v = v;
  last.time = run.state.clock.time();
}

/// Sets critical damping for modes of angular frequency `omega` [1/s].
void damp(RunContext& run, double omega) {
  run.state.relaxation.damping = std::max(0.0, 2 * omega - material_damping(run));
  run.upload_decay();
  upload_coupling(run);
}

// A body in float never comes to rest: rounding of u excites its highest modes, whose forces hide those of the lowest. This
// motion has as much elastic as kinetic energy, so it adds four times `fast` to -du . df (two ends, and half of the variance
// in a mean of two). Its momentum contributes to a mean force only as 1 / time.
void relax_elements(RunContext& run) {
  RelaxationState& last = run.state.relaxation;
  const std::vector<double> u = run.loaded.u();
  const std::vector<double> force = run.forces_now();
  const std::vector<double> v = velocities(run);
  const bool first = last.u.empty();
  const double c = material_damping(run) + last.damping, now = run.state.clock.time();
  Sums sums = sum(run, u, force, v);
  const double scale = std::sqrt(std::max(sums.external, sums.reaction));
  last.residual = scale > 0 ? std::sqrt(sums.residual) / scale : (sums.residual > 0 ? 1 : 0);
  bool settled = false, hidden = false;
  if (!first && only_rounding(run, sums, c)) {
    const double noise = 4 * sums.fast, x = c * (now - last.time) / 2;
    sums.stiffness -= noise;
    hidden = std::abs(sums.stiffness) <= kStandsOut * noise;
    if (scale > 0 && last.time >= loads_end(run)) {
      // A critically damped mode decays as exp(-c t / 2): computes its force at the end from the mean.
      const double end = std::sqrt(std::max(0.0, sums.mean - sums.mean_noise)) * x / std::expm1(x);
      last.residual = std::min(last.residual, std::max(end, std::sqrt(sums.mean_noise)) / scale);
      settled = hidden && x >= kSettled;
    }
  }
  last.equilibrium = now >= loads_end(run) && (settled || last.residual <= run.scene.relaxation.tolerance);
  if (hidden) return;
  if (sums.stiffness > 0 && sums.inertia > 0) damp(run, std::sqrt(sums.stiffness / sums.inertia));
  remember(run, u, force, v);
}

/// Returns true if nodes move periodically with shape matching: it pulls them once in `substeps` steps, and in between the
/// elements and the springs to held goals pull them back. At equilibrium they have the same velocity after each of these
/// steps, determined by the damping.
bool has_rhythm(const Model& model) {
  return std::any_of(model.flsm.begin(), model.flsm.end(),
                     [](const FlsmBatch& b) { return b.interface > 0 && b.settings.substeps > 1; });
}

/// Shape matching has no force that could be distinguished from rounding. The forces on its nodes and on those of the
/// elements follow from their momentum instead: the mean force since the last update is m (dv + c du) / time, to which motion
/// of velocity w faster than that time contributes at most 2 m w / time. -du . df and du . M du are computed from two such
/// means and the corresponding mean positions.
void relax_by_momentum(RunContext& run) {
  RelaxationState& last = run.state.relaxation;
  const Model& model = run.model();
  const double now = run.state.clock.time(), time = now - last.time;
  const double x = (material_damping(run) + last.damping) * time / 2;
  const bool rhythm = has_rhythm(model), first = last.middle.empty();
  if (!first && !last.v.empty() && x > 0 && x < kInterval) return;
  const std::vector<double> u = run.loaded.u(), v = velocities(run), force = run.forces_now();
  if (last.v.empty()) return remember(run, u, last.force.empty() ? std::vector<double>(u.size()) : last.force, v);
  if (rhythm && last.steady.empty()) {
    last.steady.resize(u.size());
    for (std::size_t t = 0; t < u.size(); ++t) last.steady[t] = (v[t] + last.v[t]) / 2 - (u[t] - last.u[t]) / time;
    return;
  }
  const Sums sums = sum(run, u, force, v);
  std::vector<double> mean(u.size()), middle(u.size());
  double stiffness = 0, inertia = 0, change = 0, noise = 0, carried = 0;
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    const double m = model.mass[s];
    if (!(m > 0)) continue;
    for (std::size_t t = 4 * s; t < 4 * s + 3; ++t) {
      carried += force[t] * force[t];  // at equilibrium the load that the other model's nodes or a support carry
      if (!run.loaded.free()[3 * s + t - 4 * s]) continue;
      const double du = u[t] - last.u[t], fast = fast_velocity(last, u, v, time, t);
      mean[t] = m * (v[t] - last.v[t] + (model.damping[s] + last.damping) * du) / time;
      middle[t] = (u[t] + last.u[t]) / 2;
      if (first) continue;
      const double shift = middle[t] - last.middle[t], df = mean[t] - last.force[t];
      stiffness -= shift * df;
      inertia += m * shift * shift;
      change += df * df / m;
      noise += 8 * m * fast * fast / (time * time);  // of both means
    }
  }
  last.largest = std::max(last.largest, std::sqrt(sums.mean));
  const double loads = std::sqrt(std::max(sums.external, carried)), scale = loads > 0 ? loads : last.largest;
  const double slow = std::sqrt(std::max(0.0, sums.mean - sums.mean_noise)), fast = std::sqrt(sums.mean_noise);
  // A critically damped mode has a smaller force at the end than on average; the estimate assumes at most one time constant.
  const double left = std::min(x, 1.0) / std::expm1(std::min(x, 1.0));
  last.residual = scale > 0 ? std::max(x > 0 ? slow * left : slow, fast) / scale : 0;
  const double tolerance = run.scene.relaxation.tolerance;
  last.equilibrium = last.time >= loads_end(run) && x >= kInterval && last.residual <= tolerance;
  double omega = 0;
  if (!first && change <= kStandsOut * noise) {
    // A small change may be rounding; over a longer time slow motion becomes visible. Fast motion must be damped.
    if (x > 0 && (x < 1 || (fast <= kLittle * tolerance * scale && x < kSettled))) return;
    omega = std::max(last.damping, 2 / time);
  } else if (stiffness > 0 && inertia > 0) {
    omega = std::sqrt(stiffness / inertia);
  } else if (!first && !(last.damping > 0)) {
    omega = 2 / time;
  }
  last.middle = middle;
  remember(run, u, mean, v);
  if (!(omega > 0)) return;
  damp(run, omega);
  if (!rhythm) return;
  last.v.clear();
  last.steady.clear();
}

}  // namespace

void relax(RunContext& run) {
  // Contact forces are not part of the forces of elements and loads.
  if (run.model().flsm.empty() && run.model().contact == nullptr)
    relax_elements(run);
  else
    relax_by_momentum(run);
}

}  // namespace pliant
