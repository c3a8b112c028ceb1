// Newton-Raphson: load steps, iterations, line search.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "pliant/error.h"
#include "statics/cholesky.h"
#include "statics/system.h"

namespace pliant::statics {
namespace {

constexpr double kSmallestStep = 1.0 / 4096;  ///< of the loads
constexpr double kLargestTurn = 0.5;          ///< change of the displacement gradient in one iteration
constexpr int kBold = 16;                     ///< iterations of a load step before the line search becomes strict
constexpr int kMostSolves = 60;               ///< with one factorisation
constexpr double kSolved = 1e-9;              ///< relative residual of a direction
constexpr double kEps = std::numeric_limits<double>::epsilon();

class Newton {
 public:
  Newton(const System& system, const std::vector<Vec3d>& rest, const Settings& settings)
      : system_(system), settings_(settings), stiffness_(system.pattern()), u_(VectorXd::Zero(system.components())) {
    std::vector<int> node(system_.unknowns());
    for (int i = 0; i < system_.components(); ++i) {
      if (const int f = system_.free_of()[i]; f >= 0) node[f] = i / 3;
    }
    cholesky_.analyze(stiffness_, node, rest);
  }

  Solution run() {
    const double whole = settings_.linear || settings_.load_steps <= 0 ? 1.0 : 1.0 / settings_.load_steps;
    double step = whole;
    while (load_ < 1) {
      const double target = load_ + step > 1 - 1e-9 ? 1 : load_ + step;
      const VectorXd before = u_;
      LoadStep record;
      record.load = target;
      if (advance(target, record)) {
        load_ = target;
        out_.steps.push_back(std::move(record));
        const bool easy = out_.steps.back().iterations <= 8;
        if (easy && step < whole) step = std::min(whole, 2 * step);
        continue;
      }
      wasted_ += record.iterations;
      u_ = before;
      step /= 2;
      if (settings_.linear || step < kSmallestStep * whole || wasted_ > 20 * settings_.max_iterations) {
        finish();
        out_.failure = fmt::format("stopped at {:.4g} of the load: {}", load_, why_);
        return std::move(out_);
      }
    }
    finish();
    out_.converged = true;
    return std::move(out_);
  }

 private:
  [[nodiscard]] VectorXd free_residual(const Forces& f) const { return system_.free_part(f.internal - f.external); }

  /// What the residual is measured by: the largest of the external force and the internal one with reactions.
  [[nodiscard]] static double scale_of(const Forces& f) { return std::max(f.external.norm(), f.internal.norm()); }
  [[nodiscard]] double relative(const Forces& f, double residual) const {
    const double scale = scale_of(f);
    return scale > 0 ? residual / scale : 0;
  }
  /// Rounding errors of the element forces keep the residual from falling below about this [N].
  [[nodiscard]] bool good_enough(const Forces& f, double residual) const {
    return residual <= std::max(settings_.tolerance * scale_of(f), 8 * kEps * f.sum_of_sizes);
  }

  /// From the converged state at load_ to `target`.
  bool advance(double target, LoadStep& record) {
    const VectorXd moved = (target - load_) * system_.prescribed();
    bool predict = moved.cwiseAbs().maxCoeff() > 0;
    Forces now;
    VectorXd moved_force;
    for (int i = 0; i <= settings_.max_iterations; ++i) {
      if (!system_.tangent(u_, target, now, stiffness_, &moved_force, predict ? &moved : nullptr))
        return give_up("an element is turned inside out");
      const VectorXd residual = free_residual(now);
      const double size = residual.norm();
      record.residuals.push_back(relative(now, size));
      if (settings_.progress) settings_.progress(target, i, record.residuals.back());
      if (!std::isfinite(size)) return give_up("the forces are not finite");
      if (!predict && good_enough(now, size)) return true;
      if (i == settings_.max_iterations) break;
      record.iterations = i + 1;
      if (system_.unknowns() > 0 && !factorize())
        return give_up("the stiffness is singular (a part hinged at a node or an edge?)");
      const VectorXd d = direction(predict ? moved : VectorXd::Zero(system_.components()),
                                   -residual - (predict ? moved_force : zero()), target);
      if (!d.allFinite()) return give_up("the stiffness is singular (a part hinged at a node or an edge?)");
      if (settings_.linear) {
        u_ += d;
      } else if (!search(d, predict, target, residual, i)) {
        return false;
      }
      predict = false;
      if (settings_.linear && i == 1) return give_up("the stiffness is too badly conditioned for the tolerance");
    }
    return give_up(fmt::format("no convergence within {} iterations (relative residual {:.3g}, tolerance {:.3g})",
                               settings_.max_iterations, record.residuals.back(), settings_.tolerance));
  }

  /// `moved`, and the free components d that solve (K + A) d = force - A moved, with K the tangent, which is factorised, and A
  /// the unsymmetric part of what pressures add: GMRES (Saad and Schultz 1986) on (1 + K^-1 A) d, which takes a few solves as A
  /// acts at the rims of surfaces alone.
  [[nodiscard]] VectorXd direction(const VectorXd& moved, const VectorXd& force, double target) const {
    if (system_.unknowns() == 0) return moved;
    if (!system_.has_skew_part()) return moved + system_.spread(cholesky_.solve(force));
    const VectorXd start = cholesky_.solve(force - system_.skew_product(u_, target, moved));
    const double size = start.norm();
    if (!(size > 0) || !std::isfinite(size)) return moved + system_.spread(start);
    std::vector<VectorXd> basis{start / size};
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kMostSolves + 1, kMostSolves);
    VectorXd weights;
    for (int k = 0; k < kMostSolves; ++k) {
      VectorXd next = basis[k] + cholesky_.solve(system_.skew_product(u_, target, system_.spread(basis[k])));
      for (int i = 0; i <= k; ++i) {
        h(i, k) = basis[i].dot(next);
        next -= h(i, k) * basis[i];
      }
      h(k + 1, k) = next.norm();
      const Eigen::MatrixXd block = h.topLeftCorner(k + 2, k + 1);
      const VectorXd wanted = size * VectorXd::Unit(k + 2, 0);
      weights = block.colPivHouseholderQr().solve(wanted);
      if ((block * weights - wanted).norm() <= kSolved * size || !(h(k + 1, k) > 0)) break;
      basis.push_back(next / h(k + 1, k));
    }
    VectorXd d = VectorXd::Zero(system_.unknowns());
    for (Eigen::Index i = 0; i < weights.size(); ++i) d += weights[i] * basis[i];
    return moved + system_.spread(d);
  }

  [[nodiscard]] VectorXd zero() const { return VectorXd::Zero(system_.unknowns()); }

  bool give_up(const std::string& why) {
    why_ = why;
    return false;
  }

  /// Where the tangent is not positive definite, the smallest shift of its diagonal that makes it so: the step then still goes
  /// downhill, and what it finds is a stable equilibrium.
  bool factorize() {
    if (cholesky_.factorize(stiffness_, 0)) return true;
    if (settings_.linear) return false;
    const double mean = stiffness_.diagonal().cwiseAbs().mean();
    for (double shift = 1e-4; shift < 1e3; shift *= 4) {
      if (cholesky_.factorize(stiffness_, shift * mean)) return true;
    }
    return false;
  }

  /// The work that the residual does along d, relative to that at the start of the line; +infinity where an element is
  /// inverted.
  [[nodiscard]] double slope(const VectorXd& d, double s, double target, double first) const {
    Forces f;
    if (!system_.forces(u_ + s * d, target, f)) return HUGE_VAL;
    const double value = d.dot(f.internal - f.external) / first;
    return std::isfinite(value) ? value : HUGE_VAL;
  }

  /// Moves u_ along d until the residual does at most half as much work along d as at the start; all of d when d moves
  /// prescribed components. Roots of the slope are bracketed and approached by regula falsi (Illinois).
  bool search(const VectorXd& d, bool predict, double target, const VectorXd& residual, int iteration) {
    if (predict) {
      Forces f;
      if (!system_.forces(u_ + d, target, f)) return give_up("an element is turned inside out");
      u_ += d;
      return true;
    }
    const double first = -system_.free_part(d).dot(residual);  // > 0: d goes downhill
    if (!(first > 0)) {
      u_ += d;  // at the level of rounding
      return true;
    }
    // Far from equilibrium the linear step may be many times too long; beyond a turn of this size it says nothing.
    const bool bold = iteration < kBold;
    double high = std::min(1.0, kLargestTurn / system_.largest_gradient(d));
    double low = 0, at_low = -1, at_high = slope(d, high, target, first);
    double s = high, at = at_high;
    for (int i = 0; i < 12 && (bold ? !std::isfinite(at) : at > 0.5); ++i) {
      s = std::isfinite(at_high) ? (low * at_high - high * at_low) / (at_high - at_low) : (low + high) / 2;
      s = std::clamp(s, low + 0.05 * (high - low), high - 0.05 * (high - low));
      at = slope(d, s, target, first);
      if (std::abs(at) <= 0.5 || (bold && std::isfinite(at))) break;
      if (at < 0) {
        low = s;
        at_low = at;
        if (std::isfinite(at_high)) at_high /= 2;
      } else {
        high = s;
        at_high = at;
        at_low /= 2;
      }
    }
    if (!std::isfinite(at)) return give_up("every step turns an element inside out");
    u_ += s * d;
    return true;
  }

  void finish() {
    Forces f;
    if (!system_.forces(u_, load_, f)) throw Error(ErrorCode::internal, "static solver: its converged state has no forces");
    const VectorXd reaction = f.internal - f.external;
    const std::size_t nodes = static_cast<std::size_t>(system_.components()) / 3;
    for (std::size_t n = 0; n < nodes; ++n) {
      out_.displacement.push_back(plain(u_.segment<3>(static_cast<Eigen::Index>(3 * n))));
      out_.reaction.push_back(plain(reaction.segment<3>(static_cast<Eigen::Index>(3 * n))));
    }
    for (std::size_t i = 0; i < 3 * nodes; ++i) out_.applied[i % 3] += f.external[static_cast<Eigen::Index>(i)];
    out_.load = load_;
    out_.strain_energy = f.energy;
    out_.residual = relative(f, system_.free_part(reaction).norm());
    out_.unknowns = system_.unknowns();
  }

  const System& system_;
  const Settings& settings_;
  SparseMatrix stiffness_;
  Cholesky cholesky_;
  VectorXd u_;
  double load_ = 0;
  int wasted_ = 0;
  std::string why_;
  Solution out_;
};

}  // namespace

int Solution::iterations() const {
  int sum = 0;
  for (const LoadStep& step : steps) sum += step.iterations;
  return sum;
}

std::vector<Vec3d> reactions(const Problem& problem, const Solution& solution) {
  std::map<std::pair<std::int32_t, int>, std::int32_t> holder;
  std::int32_t sets = 0;
  for (const Prescribed& p : problem.prescribed) {
    holder[{p.node, p.axis}] = p.set;
    sets = std::max(sets, p.set + 1);
  }
  std::vector<Vec3d> out(static_cast<std::size_t>(sets));
  for (const auto& [component, set] : holder)
    out[set][component.second] += solution.reaction[component.first][component.second];
  return out;
}

Solution solve(const Problem& problem, const Settings& settings) {
  if (!(settings.tolerance > 0 && settings.tolerance < 1))
    throw Error(ErrorCode::bad_input,
                fmt::format("static solver: tolerance {}, expected 0 < tolerance < 1", settings.tolerance));
  if (settings.max_iterations < 1)
    throw Error(ErrorCode::bad_input,
                fmt::format("static solver: max_iterations {}, expected 1 or more", settings.max_iterations));
  const System system(problem, settings.linear);
  return Newton(system, problem.mesh.nodes, settings).run();
}

}  // namespace pliant::statics
