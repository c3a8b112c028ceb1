// What the two forms of central differences share: velocities stand between two displacements.
#pragma once
#include <cmath>

#include "integrators/integrator.h"

namespace pliant::integrators {

/// u_0 - u_(-1) [m], so that the first step is that of a parabola through the initial position and velocity.
inline double first_increment(const Start& s) { return s.h * s.v - 0.5 * s.h * s.h * s.a; }

inline double central_decay(double k) { return (1 - k) / (1 + k); }

/// v_(n-1/2) v_(n+1/2): with it the energy of an undamped linear body is constant, to rounding (Krenk 2006). The squares of one
/// of the two swing by omega h.
inline double central_square(double v, double a, double h, double k) { return v * ((1 - k) * v + h * a) / (1 + k); }

/// 2 / omega, whatever the damping of the mass: w' = a w - b omega^2 u is stable for b omega^2 <= 2 (1 + a), and b = h^2 (1 +
/// a) / 2.
inline double central_step(double omega2, double /*least*/, double /*most*/) { return 2 / std::sqrt(omega2); }

}  // namespace pliant::integrators
