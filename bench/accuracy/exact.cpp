// Exact answers at the sample points.
#include <cmath>

#include "bench/accuracy/parts.h"

namespace pliant::bench::accuracy {
namespace {

struct ExactModuli {
  double mu = 0, lambda = 0;
};
ExactModuli moduli(const Problem& p) {
  return {p.young / (2 * (1 + p.poisson)), p.young * p.poisson / ((1 + p.poisson) * (1 - 2 * p.poisson))};
}

/// Root of a function that rises from `low` to `high`, by bisection to the last bit.
double root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Reissner's plane beam: position r, angle theta and moment M along the rest length s under a constant section force (0, -P).
struct BeamState {
  double x = 0, y = 0, theta = 0, moment = 0;
};
struct Beam {
  double axial = 0, shear = 0, bending = 0, load = 0;  ///< E A, G A 5/6 [N], E I [N m^2], P [N]
  [[nodiscard]] BeamState rate(const BeamState& s) const {
    const double c = std::cos(s.theta), n = std::sin(s.theta);
    const double stretch = 1 - load * n / axial, slide = -load * c / shear;
    const double dx = stretch * c - slide * n, dy = stretch * n + slide * c;
    return {dx, dy, s.moment / bending, load * dx};
  }
};
BeamState ahead(const BeamState& s, const BeamState& d, double h) {
  return {s.x + h * d.x, s.y + h * d.y, s.theta + h * d.theta, s.moment + h * d.moment};
}
/// The states at `count` equal parts of `length`, from the clamp's moment, by Runge and Kutta's fourth-order rule.
std::vector<BeamState> integrate(const Beam& beam, double moment, double length, int count) {
  constexpr int kSteps = 100;  // per part
  const double h = length / count / kSteps;
  std::vector<BeamState> states(1);
  states[0].moment = moment;
  for (int i = 0; i < count; ++i) {
    BeamState s = states.back();
    for (int k = 0; k < kSteps; ++k) {
      const BeamState a = beam.rate(s), b = beam.rate(ahead(s, a, h / 2)), c = beam.rate(ahead(s, b, h / 2)),
                      d = beam.rate(ahead(s, c, h));
      s = ahead(ahead(ahead(ahead(s, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
    }
    states.push_back(s);
  }
  return states;
}

}  // namespace

/// P_xx = mu (a - 1 / a) + lambda (J - 1) J / a = 0 with J = a^2 c gives the lateral stretch a for the axial stretch c.
std::vector<Vec3d> exact_uniaxial(const Problem& p) {
  const auto [mu, lambda] = moduli(p);
  const double c = kStretch;
  const double a =
      root(0.1, 2, [&, mu = mu, lambda = lambda](double s) { return mu * (s - 1 / s) + lambda * (s * s * c - 1) * s * c; });
  std::vector<Vec3d> u;
  for (const Vec3d& x : p.samples) u.push_back({(a - 1) * x[0], (a - 1) * x[1], (c - 1) * x[2]});
  return u;
}

std::vector<Vec3d> exact_shear(const Problem& p) {
  std::vector<Vec3d> u;
  for (const Vec3d& x : p.samples) u.push_back({kShear * x[1], 0, 0});
  return u;
}

/// mu (s - 1 / s) + lambda (s - 1) = - rho g (H - Z) gives the stretch s of a layer; u_z is the integral of s - 1 from below.
std::vector<Vec3d> exact_column(const Problem& p) {
  const auto [mu, lambda] = moduli(p);
  const double height = p.size[2], weight = kDensity * -p.gravity[2];
  const auto strain = [&, mu = mu, lambda = lambda](double z) {
    return root(0.01, 1, [&](double s) { return mu * (s - 1 / s) + lambda * (s - 1) + weight * (height - z); }) - 1;
  };
  std::vector<Vec3d> u;
  for (const Vec3d& x : p.samples) {
    constexpr int kParts = 64;  // Simpson's rule
    const double h = x[2] / kParts;
    double sum = 0;
    for (int i = 0; i <= kParts; ++i) sum += strain(i * h) * (i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2);
    u.push_back({0, 0, sum * h / 3});
  }
  return u;
}

/// The tip's moment is zero. Samples stand at equal parts of the centre line.
std::vector<Vec3d> exact_elastica(const Problem& p) {
  const double length = p.size[0], side = p.size[1], area = side * side, inertia = area * area / 12;
  Beam beam{p.young * area, 5.0 / 6 * p.young / 2 * area, p.young * inertia, 0};
  beam.load = kTipLoad * beam.bending / (length * length);
  const int count = static_cast<int>(p.samples.size());
  const double clamp =
      root(-2 * beam.load * length, 0, [&](double m) { return integrate(beam, m, length, count).back().moment; });
  const auto states = integrate(beam, clamp, length, count);
  std::vector<Vec3d> u;
  for (int i = 1; i <= count; ++i) u.push_back({states[i].x - length * i / count, states[i].y, 0});
  return u;
}

}  // namespace pliant::bench::accuracy
