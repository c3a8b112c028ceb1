// Shared by the two forms of central differences: velocities lie halfway between two displacements.
#pragma once
#include <cmath>

#include "integrators/integrator.h"

namespace pliant::integrators {

/// Returns u_0 - u_(-1) [m] such that the first step is a parabola through the initial position and velocity.
inline double first_increment(const Start& s) { return s.h * s.v - 0.5 * s.h * s.h * s.a; }

inline double central_decay(double k) { return (1 - k) / (1 + k); }

/// v_(n-1/2) v_(n+1/2): with this product the energy of an undamped linear body is constant to rounding (Krenk 2006). The
/// square of either velocity oscillates by omega h.
inline double central_square(double v, double a, double h, double k) { return v * ((1 - k) * v + h * a) / (1 + k); }

/// 2 / omega, independent of mass damping: w' = a w - b omega^2 u is stable for b omega^2 <= 2 (1 + a), and b = h^2 (1 + a) /
/// 2. Viscous forces, at most t times the elastic ones, use the velocity of the last step: h^2 omega^2 + 2 h t omega^2 <= 4
/// (from w' = (1 - h t omega^2) w - h^2 omega^2 u, u' = u + w'), hence h = 2 / omega (sqrt(1 + xi^2) - xi) with xi = t omega
/// / 2.
inline double central_step(double central, const DampingRange& damping) {
  const double time = damping.most_time;
  return time > 0 ? central * central / (time + std::hypot(time, central)) : central;
}

}  // namespace pliant::integrators
