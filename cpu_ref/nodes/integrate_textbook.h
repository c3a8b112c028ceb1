// Central differences in textbook form; the formulas are in kernels/nodes/integrate_textbook.cl.
#pragma once
#include "cpu_ref/nodes/integrator.h"

namespace pliant::ref::integrators {

struct Textbook {
  template <class Scalar>
  static Scalar w_of(Scalar now, Scalar /*next*/) {
    return now;
  }
  template <class Scalar>
  static void advance(Scalar& u, Scalar& w, const Drive<Scalar>& d, const StepParameters<Scalar>& step) {
    const Scalar push = d.push(std::fma(step.half_hh, d.decay, step.half_hh));
    const Scalar next = std::fma(-d.decay, w, std::fma(Scalar(1) + d.decay, u, push));
    w = u;
    u = next;
  }
};

}  // namespace pliant::ref::integrators
