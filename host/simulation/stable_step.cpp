// The stable step 2 / omega_max of the present configuration.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulation/simulation.h"

namespace pliant {
namespace {

constexpr double kStrain = 3e-4;  ///< size of the probing displacement over the shortest element

/// A start vector with a share of every mode, the same for every run.
double noise(std::size_t i) {
  std::uint64_t z = (i + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/// How far below the largest eigenvalue the Ritz value of k Lanczos steps from a random start may lie, relative to it: 0.103
/// (ln(n (k - 1)^4) / (k - 1))^2 on average, whatever the gaps of the spectrum (Kuczynski and Wozniakowski 1992, theorem 3.2).
/// A plain power iteration needs the square of that number of steps: a mode of a few nodes at the rim of a large body hides
/// from it.
double ritz_deficit(std::size_t unknowns, int steps) {
  const double k = steps - 1, logarithm = std::log(static_cast<double>(unknowns)) + 4 * std::log(k);
  return std::min(0.5, 0.103 * logarithm * logarithm / (k * k));
}

}  // namespace

/// Lanczos iteration on M^-1 K in the norm of M. K v is a difference of two force evaluations on the backend itself: every
/// element, law and constraint is in it, at the present deformation.
/// The springs between interface nodes and their goals are no part of a force evaluation and are given: `spring` [1/s^2] per
/// slot, empty: none.
double Simulation::largest_omega2(const std::vector<double>& spring, int iterations) {
  const std::vector<double>& mass = model_->mass;
  const std::vector<double> u = backend_->read_reals(u_);
  const std::vector<double> rest_force = forces_now();
  const std::size_t n = free_.size();
  std::vector<double> v(n, 0), before(n, 0), probe = u;
  double norm = 0;
  std::size_t unknowns = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!free_[i]) continue;
    v[i] = noise(i);
    norm += mass[i / 3] * v[i] * v[i];
    ++unknowns;
  }
  const int steps = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(iterations), unknowns));
  std::vector<double> alpha, beta;  // the tridiagonal matrix
  for (int k = 0; k < steps && norm > 0 && std::isfinite(norm); ++k) {
    double largest = 0;
    const double unit = 1 / std::sqrt(norm);
    for (double& x : v) {
      x *= unit;
      largest = std::max(largest, std::abs(x));
    }
    const double size = kStrain * model_->shortest / largest;
    for (std::size_t i = 0; i < n; ++i) probe[4 * (i / 3) + i % 3] = u[4 * (i / 3) + i % 3] + size * v[i];
    backend_->write_reals(u_, probe);
    backend_->run(program_.force, 0, 1);
    const std::vector<double> force = backend_->read_reals(force_);
    double projection = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!free_[i]) continue;
      projection += v[i] * (rest_force[4 * (i / 3) + i % 3] - force[4 * (i / 3) + i % 3]) / size;
      if (!spring.empty()) projection += mass[i / 3] * spring[i / 3] * v[i] * v[i];
    }
    norm = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!free_[i]) continue;
      const std::size_t t = 4 * (i / 3) + i % 3;
      const double own = projection - (spring.empty() ? 0 : spring[i / 3]);
      const double next = (rest_force[t] - force[t]) / size / mass[i / 3] - own * v[i] - (k > 0 ? beta.back() * before[i] : 0);
      before[i] = v[i];
      v[i] = next;
      norm += mass[i / 3] * next * next;
    }
    alpha.push_back(projection);
    beta.push_back(std::sqrt(norm));
    if (!(beta.back() > 1e-6 * std::abs(projection))) break;  // the whole space is spanned
  }
  backend_->write_reals(u_, u);
  if (alpha.empty() || !std::isfinite(beta.back())) return 0;
  const auto size = static_cast<Eigen::Index>(alpha.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(alpha.data(), size),
                                Eigen::Map<Eigen::VectorXd>(beta.data(), size - 1), Eigen::EigenvaluesOnly);
  double omega2 = solver.eigenvalues()[size - 1];
  if (static_cast<std::size_t>(size) < unknowns && size > 2) omega2 /= 1 - ritz_deficit(unknowns, static_cast<int>(size));
  return omega2;
}

double Simulation::estimate_stable_dt(int iterations) {
  state_.stable_dt = elements_dt_ = 0;
  const double omega2 = largest_omega2({}, iterations);
  if (!(omega2 > 0)) return 0;
  elements_dt_ = 2 / std::sqrt(omega2);
  state_.stable_dt = coupled_step(elements_dt_);
  const std::vector<double> spring = interface_springs(state_.stable_dt);
  if (!spring.empty()) {
    // Springs soften as the step grows, so what the springs of a shorter step allow is allowed.
    const double coupled = largest_omega2(spring, iterations);
    if (coupled > 0) state_.stable_dt = std::max(state_.stable_dt, 2 / std::sqrt(coupled));
    state_.stable_dt = std::min(state_.stable_dt, held_goals_step(elements_dt_));
  }
  return state_.stable_dt;
}

}  // namespace pliant
