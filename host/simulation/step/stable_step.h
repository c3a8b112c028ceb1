// The stable step 2 / omega_max of the current configuration.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Returns the largest squared angular frequency [1/s^2], from a Lanczos iteration on M^-1 K in the norm of M. K v is a
/// difference of two force evaluations on the backend, so it includes all elements, laws and constraints at the current
/// deformation. More iterations give a tighter value; errors are on the safe side. The springs between interface nodes and
/// their goals are not part of a force evaluation and are given as `spring` [1/s^2] per slot (empty: none). Returns 0 if no
/// node moves freely.
double largest_omega2(const RunContext& run, const std::vector<double>& spring, int iterations = 48);

/// Returns the longest stable step of the elements [s] for the scene's integrator, the damping of the free nodes and the
/// viscosity; 0: no step is stable. `central`: 2 / omega of their highest mode [s].
double stable_step(const RunContext& run, double central);
/// The same including the springs of the shape-matching interface: a bound without an iteration.
double bound_step(const RunContext& run, double central);
/// Inverse of bound_step(): the 2 / omega of the elements that allows a step of `dt` [s].
double central_step_for(const RunContext& run, double dt);

/// Returns the longest step [s] that is stable with the viscous stress of the elements as they are deformed now; infinite
/// without any. Viscous forces grow with the square of the stretch, elastic ones may not, so that stable_step(), which knows
/// their ratio at rest, is too long for tissue that is drawn out. u_(n+1) - 2 u_n + u_(n-1) = -h C (u_n - u_(n-1)) - h^2 K u_n
/// is stable while h^2 K + 2 h C <= 4. Measures the largest eigenvalue of K + 2 C / h as largest_omega2() does, at the present
/// step h, and returns 4 / (h times it): safe for shorter steps, and where C is what limits the step for longer ones, too.
/// Compare it with an estimate of as many iterations.
double rates_step(const RunContext& run, int iterations);

/// Returns the longest step [s] that is stable for the networks of springs, however they deform while no spring gets stiffer
/// than it is now; infinite without networks.
double network_step(const RunContext& run);

struct StableStep {
  double elements = 0;  ///< of the elements alone [s]; 0: none is stable
  double coupled = 0;   ///< including the shape-matching interface [s]; 0: none is stable
};
StableStep estimate_stable_step(const RunContext& run, int iterations);

}  // namespace pliant
