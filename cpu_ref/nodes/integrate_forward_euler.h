// Explicit Euler; the formulas are in kernels/nodes/integrate_forward_euler.cl.
#pragma once
#include "cpu_ref/nodes/integrator.h"

namespace pliant::ref::integrators {

struct ForwardEuler {
  template <class Scalar>
  static Scalar w_of(Scalar now, Scalar next) {
    return next - now;
  }
  template <class Scalar>
  static void advance(Scalar& u, Scalar& w, const Drive<Scalar>& d, const StepParameters<Scalar>& step) {
    const Scalar next = std::fma(d.decay, w, d.push(step.h * step.h));
    u = step.displacement(u + w);
    w = step.increment(next);
  }
};

}  // namespace pliant::ref::integrators
