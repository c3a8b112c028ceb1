// Central differences in increment form; the formulas are in kernels/nodes/integrate_increment.cl.
#pragma once
#include "cpu_ref/nodes/integrator.h"

namespace pliant::ref::integrators {

struct Increment {
  template <class Scalar>
  static Scalar w_of(Scalar now, Scalar next) {
    return next - now;
  }
  template <class Scalar>
  static void advance(Scalar& u, Scalar& w, const Drive<Scalar>& d, const StepParameters<Scalar>& step) {
    w = step.increment(std::fma(d.decay, w, d.push(std::fma(step.half_hh, d.decay, step.half_hh))));
    u = step.displacement(u + w);
  }
};

}  // namespace pliant::ref::integrators
