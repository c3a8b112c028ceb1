// A step of each integrator as a textbook writes it, for one component of mass 1 under the force -omega2 u. The third leg
// beside kernel and twin.
#pragma once
#include "integrators/integrator.h"

namespace pliant::kernel_test {

/// Displacement [m], and the velocity [m/s] that the integrator has beside it.
struct Phase {
  double u, v;
};

/// c: damping rate [1/s]; h: step [s].
inline Phase textbook_step(Integrator integrator, Phase at, double omega2, double c, double h) {
  switch (integrator) {
    case Integrator::increment:
    case Integrator::textbook: {  // (v+ - v) / h + c (v+ + v) / 2 = -omega2 u with v and v+ half a step before and after u
      const double next = ((1 - c * h / 2) * at.v - h * omega2 * at.u) / (1 + c * h / 2);
      return {at.u + h * next, next};
    }
    case Integrator::forward_euler:
      return {at.u + h * at.v, at.v + h * (-omega2 * at.u - c * at.v)};
  }
  return {};
}

}  // namespace pliant::kernel_test
