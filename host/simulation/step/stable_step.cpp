#include "simulation/step/stable_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/nodes/ballast.h"
#include "simulation/step/coupling.h"

namespace pliant {
namespace {

constexpr double kStrain = 3e-4;  ///< size of the probing displacement relative to the shortest element

/// Component of the start vector, which contains every mode and is the same in every run.
double noise(std::size_t i) {
  std::uint64_t z = (i + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Relative distance of the Ritz value of k Lanczos steps from a random start below the largest eigenvalue: 0.103 (ln(n (k -
/// 1)^4) / (k - 1))^2 on average, whatever the gaps of the spectrum (Kuczynski and Wozniakowski 1992, theorem 3.2). A plain
/// power iteration needs the square of that number of steps and misses modes of a few nodes at the rim of a large body.
double ritz_deficit(std::size_t unknowns, int steps) {
  const double k = steps - 1, logarithm = std::log(static_cast<double>(unknowns)) + 4 * std::log(k);
  return std::min(0.5, 0.103 * logarithm * logarithm / (k * k));
}

/// Largest eigenvalue of the tridiagonal matrix with this diagonal and, but for its last entry, this secondary diagonal.
double largest_eigenvalue(std::vector<double>& diagonal, std::vector<double>& beside) {
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), size),
                                Eigen::Map<Eigen::VectorXd>(beside.data(), size - 1), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[size - 1];
}

}  // namespace

/// Upper bound of the rate at which dampers of springs damp a mode: the largest sum of 2 c over mass at a node (Gershgorin)
/// [1/s].
static double link_damping(const Model& model) {
  std::vector<double> sum(model.mass.size());
  const LinkPoints& points = model.links.points;
  for (const SpringBatch& batch : model.links.springs) {
    for (std::size_t s = 0; batch.damped() && s < batch.size(); ++s) {
      for (const std::int32_t p : batch.points[s]) {
        for (std::size_t a = 0; a < 8; ++a)
          sum[static_cast<std::size_t>(points.slots[p][a])] += 2 * batch.damper[s] * points.weights[p][a];
      }
    }
  }
  double most = 0;
  for (std::size_t s = 0; s < sum.size(); ++s) {
    if (model.mass[s] > 0) most = std::max(most, sum[s] / model.mass[s]);
  }
  return most;
}

double stable_step(const RunContext& run, double central) {
  const Model& model = run.model();
  constexpr double kLarge = std::numeric_limits<double>::max();
  DampingRange d{kLarge, 0, kLarge, 0};
  for (std::size_t s = 0; s < model.mass.size(); ++s) {
    if (!(model.mass[s] > 0)) continue;
    d.least_rate = std::min(d.least_rate, model.damping[s]);
    d.most_rate = std::max(d.most_rate, model.damping[s]);
  }
  for (const ElementBatch& batch : model.batches) {
    d.least_time = std::min(d.least_time, batch.material.viscous_time());
    d.most_time = std::max(d.most_time, batch.material.viscous_time());
  }
  if (!model.links.empty()) {
    // No mode is damped at a higher rate than this, and none is faster than 2 / central.
    d.least_time = 0;
    d.most_time += link_damping(model) * central * central / 4;
  }
  return integrator_info(run.scene.integrator).stable_step(central, d);
}

double bound_step(const RunContext& run, double central) { return coupled_step(run.model(), stable_step(run, central)); }

double central_step_for(const RunContext& run, double dt) {
  double low = dt, high = 2 * dt;
  for (int i = 0; i < 60 && bound_step(run, high) < dt; ++i) high *= 2;  // with some springs no elements are stiff enough
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (bound_step(run, middle) < dt ? low : high) = middle;
  }
  return high;
}

double largest_omega2(const RunContext& run, const std::vector<double>& spring, int iterations) {
  LoadedModel& loaded = run.loaded;
  const std::vector<double>& mass = run.model().mass;
  const std::vector<double> u = loaded.u();
  const std::vector<double> rest_force = run.forces_now();
  struct Unknown {
    std::size_t at;  ///< in arrays of [slots][4]
    double mass, spring;
  };
  std::vector<Unknown> unknowns;
  std::vector<double> v, before, probe = u;
  double norm = 0;
  const std::vector<char>& is_free = loaded.free();
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (!is_free[i]) continue;
    unknowns.push_back({4 * (i / 3) + i % 3, mass[i / 3], spring.empty() ? 0 : spring[i / 3]});
    v.push_back(noise(i));
    norm += mass[i / 3] * v.back() * v.back();
  }
  const std::size_t n = unknowns.size();
  before.assign(n, 0);
  const int steps = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(iterations), n));
  std::vector<double> alpha, beta;  // the tridiagonal matrix
  for (int k = 0; k < steps && norm > 0 && std::isfinite(norm); ++k) {
    double largest = 0, unit = 1 / std::sqrt(norm);
    for (double& x : v) {
      x *= unit;
      largest = std::max(largest, std::abs(x));
    }
    const double size = kStrain * run.model().shortest / largest;
    for (std::size_t i = 0; i < n; ++i) probe[unknowns[i].at] = u[unknowns[i].at] + size * v[i];
    loaded.write_u(probe);
    run.backend().run(loaded.program().force, 0, 1);
    const std::vector<double> force = loaded.force();
    double projection = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Unknown& x = unknowns[i];
      projection += v[i] * (rest_force[x.at] - force[x.at]) / size;
      if (!spring.empty()) projection += x.mass * x.spring * v[i] * v[i];
    }
    norm = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Unknown& x = unknowns[i];
      const double own = projection - x.spring;
      const double next = (rest_force[x.at] - force[x.at]) / size / x.mass - own * v[i] - (k > 0 ? beta.back() * before[i] : 0);
      before[i] = v[i];
      v[i] = next;
      norm += x.mass * next * next;
    }
    alpha.push_back(projection);
    beta.push_back(std::sqrt(norm));
    if (!(beta.back() > 1e-6 * std::abs(projection))) break;  // the whole space is spanned
  }
  loaded.write_u(u);
  loaded.clear_faults();  // of elements in configurations outside the run
  if (alpha.empty() || !std::isfinite(beta.back())) return 0;
  const double omega2 = largest_eigenvalue(alpha, beta);
  return alpha.size() < n && alpha.size() > 2 ? omega2 / (1 - ritz_deficit(n, static_cast<int>(alpha.size()))) : omega2;
}

/// Networks whose springs have stiffened: the bound at rest, or that of each node now, whichever is larger.
static double stiffened_bound(const RunContext& run) {
  const Model& model = run.model();
  const std::vector<double> u = run.loaded.u();
  std::vector<char> slots(model.mass.size());
  double ratio = 1;
  for (const SpringBatch& b : model.links.springs) {
    if (!b.network) continue;
    if (stiffens(b.law)) ratio = std::max(ratio, stiffening(model.links.points, b, u));
    for (const auto& ends : b.points) {
      for (const std::int32_t p : ends) slots[static_cast<std::size_t>(model.links.points.slots[p][0])] = 1;
    }
  }
  if (!(ratio > 1)) return model.network_bound;
  return std::max(model.network_bound / std::sqrt(ratio), stiffness_bound(model, nodal_stiffness(model, u, slots)));
}

static bool may_stiffen(const Model& model) {
  return std::any_of(model.links.springs.begin(), model.links.springs.end(),
                     [](const SpringBatch& b) { return b.network && stiffens(b.law); });
}

double network_step(const RunContext& run) {
  const Model& model = run.model();
  if (!(model.network_bound > 0)) return std::numeric_limits<double>::infinity();
  return bound_step(run, may_stiffen(model) ? stiffened_bound(run) : model.network_bound);
}

StableStep estimate_stable_step(const RunContext& run, int iterations) {
  StableStep step;
  const double omega2 = largest_omega2(run, {}, iterations);
  if (!(omega2 > 0)) {
    // A network of springs that are flat at rest has no frequency yet.
    if (run.model().network_bound > 0 && may_stiffen(run.model())) step.elements = step.coupled = network_step(run);
    return step;
  }
  step.elements = stable_step(run, 2 / std::sqrt(omega2));
  step.coupled = coupled_step(run.model(), step.elements);
  const std::vector<double> spring = interface_springs(run.model(), step.coupled);
  if (!spring.empty()) {
    // The springs soften as the step grows, so the step that is stable with the springs of a shorter step is stable.
    const double coupled = largest_omega2(run, spring, iterations);
    if (coupled > 0) step.coupled = std::max(step.coupled, stable_step(run, 2 / std::sqrt(coupled)));
    step.coupled = std::min(step.coupled, held_goals_step(run.model(), step.elements));
  }
  const double network = network_step(run);
  step.elements = std::min(step.elements, network);
  step.coupled = std::min(step.coupled, network);
  return step;
}

}  // namespace pliant
