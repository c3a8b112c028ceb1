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

/// Of an element or a spring, or else the spacing of shape matching that joins of bodies pull.
double shortest_length(const Model& model) {
  if (model.shortest > 0) return model.shortest;
  double least = std::numeric_limits<double>::infinity();
  for (const FlsmBatch& b : model.flsm) least = std::min(least, b.spacing);
  return least;
}

/// Differences of forces for small displacements.
class Probe {
 public:
  /// `rates`: includes the viscous forces of a displacement that continues for two steps (rates_step()).
  Probe(const RunContext& run, bool rates)
      : run_(run),
        passes_(rates ? run.loaded.program().rates : run.loaded.program().force),
        u_(run.loaded.u()),
        w_(rates ? run.loaded.w() : std::vector<double>()) {
    run.upload_params();
    run.upload_curves(0);
    rest_ = force();
  }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;
  ~Probe() {
    write(u_, w_);
    run_.loaded.clear_faults();  // of elements in configurations outside the run
  }
  /// The force at rest less that at `size` times `v`, at the places `at` of an array of [slots][4].
  std::vector<double> operator()(const std::vector<std::size_t>& at, const std::vector<double>& v, double size) {
    std::vector<double> u = u_, w = w_, change(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) u[at[i]] = u_[at[i]] + size * v[i];
    for (std::size_t i = 0; i < v.size() && !w.empty(); ++i) w[at[i]] = w_[at[i]] + 2 * size * v[i];
    write(u, w);
    const std::vector<double> moved = force();
    for (std::size_t i = 0; i < v.size(); ++i) change[i] = rest_[at[i]] - moved[at[i]];
    return change;
  }

 private:
  void write(const std::vector<double>& u, const std::vector<double>& w) {
    run_.loaded.write_u(u);
    if (!w.empty()) run_.loaded.write_w(w);
  }
  /// The links of nodes that only shape matching moves are loads on them.
  std::vector<double> force() {
    const LoadedModel& loaded = run_.loaded;
    run_.backend().run(passes_, 0, 1);
    std::vector<double> out = loaded.force();
    if (run_.model().links.empty() || run_.model().flsm.empty()) return out;
    const std::vector<double> load = run_.backend().read_reals(loaded.program().find("node_load"));
    for (const FlsmBatch& b : run_.model().flsm) {
      for (std::int32_t i = 0; i < b.own; ++i) {
        const std::size_t at = 4 * static_cast<std::size_t>(b.slot[i]);
        for (std::size_t c = 0; c < 3; ++c) out[at + c] = load[at + c];
      }
    }
    return out;
  }
  const RunContext& run_;
  const std::vector<Pass>& passes_;
  std::vector<double> u_, w_, rest_;
};

double largest_omega2_of(const RunContext& run, const std::vector<double>& spring, int iterations, bool rates) {
  const std::vector<double>& mass = run.model().mass;
  std::vector<std::size_t> at;  // in arrays of [slots][4]
  std::vector<double> v, before, m, own_spring;
  double norm = 0;
  const std::vector<char>& is_free = run.loaded.free();
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (!is_free[i]) continue;
    at.push_back(4 * (i / 3) + i % 3);
    m.push_back(mass[i / 3]);
    own_spring.push_back(spring.empty() ? 0 : spring[i / 3]);
    v.push_back(noise(i));
    norm += mass[i / 3] * v.back() * v.back();
  }
  const std::size_t n = at.size();
  before.assign(n, 0);
  Probe probe(run, rates);
  const int steps = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(iterations), n));
  std::vector<double> alpha, beta;  // the tridiagonal matrix
  bool spanned = false;             // the whole space is
  for (int k = 0; k < steps && !spanned && norm > 0 && std::isfinite(norm); ++k) {
    double largest = 0, unit = 1 / std::sqrt(norm);
    for (double& x : v) {
      x *= unit;
      largest = std::max(largest, std::abs(x));
    }
    const double size = kStrain * shortest_length(run.model()) / largest;
    const std::vector<double> change = probe(at, v, size);
    double projection = 0;
    for (std::size_t i = 0; i < n; ++i) {
      projection += v[i] * change[i] / size;
      if (!spring.empty()) projection += m[i] * own_spring[i] * v[i] * v[i];
    }
    norm = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double own = projection - own_spring[i];
      const double next = change[i] / size / m[i] - own * v[i] - (k > 0 ? beta.back() * before[i] : 0);
      before[i] = v[i];
      v[i] = next;
      norm += m[i] * next * next;
    }
    alpha.push_back(projection);
    beta.push_back(std::sqrt(norm));
    spanned = !(beta.back() > 1e-6 * std::abs(projection));
  }
  if (alpha.empty() || !std::isfinite(beta.back())) return 0;
  const double omega2 = largest_eigenvalue(alpha, beta);
  if (rates && spanned) return omega2;
  return alpha.size() < n && alpha.size() > 2 ? omega2 / (1 - ritz_deficit(n, static_cast<int>(alpha.size()))) : omega2;
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
  return largest_omega2_of(run, spring, iterations, false);
}

double rates_step(const RunContext& run, int iterations) {
  const auto viscous = [](const ElementBatch& batch) { return batch.material.viscous(); };
  const auto& batches = run.model().batches;
  const double dt = run.state.clock.dt;
  if (std::none_of(batches.begin(), batches.end(), viscous)) return std::numeric_limits<double>::infinity();
  const double omega2 = largest_omega2_of(run, {}, iterations, true);
  return omega2 > 0 ? 4 / (dt * omega2) : std::numeric_limits<double>::infinity();
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
    // Slack springs that do not pull yet may pull bodies of shape matching alone.
    else if (!run.model().links.empty() && run.model().element_bound > 0)
      step.elements = step.coupled = bound_step(run, run.model().element_bound);
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
