#include <algorithm>
#include <cmath>
#include <limits>

#include "model/links/links.h"

namespace pliant {
namespace {

/// Integral of e / (a e + b) from 0, for a e + b > 0: (b / a^2) (r - log(1 + r)) with r = a e / b, without cancellation at
/// small r.
double measured_energy(double a, double b, double e) {
  const double r = a * e / b;
  if (std::fabs(r) > 1e-3) return b / (a * a) * (r - std::log1p(r));
  return e * e / b * (1.0 / 2 - r * (1.0 / 3 - r * (1.0 / 4 - r / 5)));
}

SpringState measured_state(double a, double b, double e) {
  const double size = std::fabs(e), limit = a < 0 ? -Spring::kMostOfPole * b / a : size, most = std::min(size, limit);
  const double rest = size - most, low = a * most + b, slope = b / (low * low), force = most / low;
  SpringState s{force + slope * rest, slope, measured_energy(a, b, most) + rest * (force + slope * rest / 2)};
  if (e < 0) s.force = -s.force;
  if (rest == 0 && a == 0) s.slope = 1 / b;
  return s;
}

/// Force and slope of a polygon, and the integral of the force from 0.
SpringState curve_state(const std::vector<std::array<double, 2>>& curve, double e) {
  const auto at = [&](double x) {
    std::size_t k = 0;
    while (k + 2 < curve.size() && x >= curve[k + 1][0]) ++k;
    const double slope = (curve[k + 1][1] - curve[k][1]) / (curve[k + 1][0] - curve[k][0]);
    return SpringState{curve[k][1] + slope * (x - curve[k][0]), slope, 0};
  };
  SpringState s = at(e);
  const double low = std::min(e, 0.0), high = std::max(e, 0.0);
  std::vector<double> ends{low};
  for (std::size_t k = 1; k + 1 < curve.size(); ++k) {
    if (curve[k][0] > low && curve[k][0] < high) ends.push_back(curve[k][0]);
  }
  ends.push_back(high);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) s.energy += (ends[k + 1] - ends[k]) * at((ends[k] + ends[k + 1]) / 2).force;
  if (e < 0) s.energy = -s.energy;
  return s;
}

}  // namespace

std::int32_t LinkPoints::add_node(std::int32_t slot, const Vec3d& place) {
  rest.push_back(place);
  slots.emplace_back().fill(slot);
  weights.push_back({1});
  return static_cast<std::int32_t>(rest.size()) - 1;
}

SpringBatch SpringBatch::without_broken() const {
  if (broken.empty()) return *this;
  SpringBatch out{law, body, join, label, {}, {}, {}, {}, {}, bars, stiffness_damping, listed, network, radius, omega2};
  for (std::size_t s = 0; s < size(); ++s) {
    if (!whole(s)) continue;
    out.points.push_back(points[s]);
    out.length.push_back(length[s]);
    out.parameters.push_back(parameters[s]);
    out.damper.push_back(damper[s]);
  }
  return out;
}

SpringState spring_state(const Spring& law, const std::array<double, 2>& parameters, double e) {
  if (law.slack && e <= 0) return {};
  const auto& [first, second] = parameters;
  switch (law.law) {
    case SpringLaw::linear:
      return {second * e, second, second * e * e / 2};
    case SpringLaw::cubic:
      return {(first * e * e + second) * e, 3 * first * e * e + second, (first * e * e / 2 + second) * e * e / 2};
    case SpringLaw::measured:
      return measured_state(first, second, e);
    case SpringLaw::curve:
      break;
  }
  const SpringState s = curve_state(law.curve, e);
  if (law.slack && s.force <= 0) return {};
  return {second * s.force, second * s.slope, second * s.energy};
}

double rest_stiffness(const Spring& law, const std::array<double, 2>& parameters) {
  double slope = 0;
  if (law.slack) {
    Spring taut = law;
    taut.slack = false;  // stiff as soon as it is longer than at rest
    slope = spring_state(taut, parameters, 0).slope;
  } else {
    slope = spring_state(law, parameters, 0).slope;
  }
  if (law.law != SpringLaw::curve || slope > 0) return slope;
  for (std::size_t k = 0; k + 1 < law.curve.size(); ++k) {
    const double s = parameters[1] * (law.curve[k + 1][1] - law.curve[k][1]) / (law.curve[k + 1][0] - law.curve[k][0]);
    if (s > 0 && (slope == 0 || s < slope)) slope = s;
  }
  return slope;
}

bool stiffens(const Spring& law) {
  switch (law.law) {
    case SpringLaw::linear:
      return false;
    case SpringLaw::cubic:
      return law.lambda1 > 0;
    case SpringLaw::measured:
      return law.a < 0;
    case SpringLaw::curve:
      break;
  }
  return true;
}

double stiffening(const LinkPoints& points, const SpringBatch& b, const std::vector<double>& u) {
  const auto moved = [&](std::int32_t slot) {
    const double* at = u.data() + 4 * static_cast<std::size_t>(slot);
    return Vec3d{at[0], at[1], at[2]};
  };
  double most = 1;
  for (std::size_t s = 0; s < b.size(); ++s) {
    if (!b.whole(s)) continue;
    const double rest = rest_stiffness(b, s);
    const double e = elongation(points, b, s, moved), length = std::max(b.length[s] + e, 1e-30);
    const SpringState state = spring_state(b.law, b.parameters[s], e);
    const double now = std::max(state.slope, state.force / length);
    if (now > rest) most = std::max(most, rest > 0 ? now / rest : std::numeric_limits<double>::infinity());
  }
  return most;
}

std::array<double, 2> spring_parameters(const Spring& law, double l0, double share, double stiffness) {
  switch (law.law) {
    case SpringLaw::linear:
      return {0, share * stiffness};
    case SpringLaw::cubic:
      return {share * law.lambda1 / (l0 * l0 * l0), share * law.lambda2 / l0};
    case SpringLaw::measured:
      return {law.a / share, law.b / share};
    case SpringLaw::curve:
      break;
  }
  return {0, share};
}

}  // namespace pliant
