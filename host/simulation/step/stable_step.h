// The stable step 2 / omega_max of the present configuration.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// The largest squared angular frequency [1/s^2], by a Lanczos iteration on M^-1 K in the norm of M. K v is a difference of two
/// force evaluations on the backend itself: every element, law and constraint is in it, at the present deformation. More
/// iterations make it tighter; it errs on the safe side. The springs between interface nodes and their goals are no part of a
/// force evaluation and are given: `spring` [1/s^2] per slot, empty: none. 0 if nothing moves freely.
double largest_omega2(const RunContext& run, const std::vector<double>& spring, int iterations = 48);

/// Longest stable step [s] of the elements, by the scene's integrator, the damping of the nodes that move and the viscosity; 0:
/// none is. `central` = 2 / omega of their highest mode [s].
double stable_step(const RunContext& run, double central);
/// The same with the springs of the interface of shape matching: a bound without an iteration.
double bound_step(const RunContext& run, double central);
/// The 2 / omega that elements need for a bound_step() of `dt` [s].
double central_step_for(const RunContext& run, double dt);

struct StableStep {
  double elements = 0;  ///< of the elements alone [s]; 0: none
  double coupled = 0;   ///< with the interface of shape matching [s]; 0: none
};
StableStep estimate_stable_step(const RunContext& run, int iterations);

}  // namespace pliant
