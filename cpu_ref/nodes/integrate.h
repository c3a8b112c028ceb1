// Common end of every update: external loads and a step of the integrator.
#pragma once
#include <cstdint>

#include "cpu_ref/nodes/integrator.h"

namespace pliant::ref {

/// The defines of an update kernel.
struct UpdateKind {
  bool has_load = false;    ///< R comes from node_load
  bool force_only = false;  ///< write R - F to node_force and do not move the node
  int integrator = 0;       ///< index in integrators.h
};

/// Advances node i with the summed element force f.
template <UpdateKind Kind, class Scalar>
inline void integrate(const Scalar (&f)[3], Scalar* node_u, Scalar* node_w, const Scalar* node_load, Scalar* node_force,
                      const StepParameters<Scalar>& step, std::int64_t i) {
  const auto residual = [&](int c) { return Kind.has_load ? node_load[4 * i + c] - f[c] : -f[c]; };
  if constexpr (Kind.force_only) {
    for (int c = 0; c < 3; ++c) node_force[4 * i + c] = residual(c);
    node_force[4 * i + 3] = Scalar(0);
  } else {
    Scalar* u = node_u + 4 * i;
    Scalar* w = node_w + 4 * i;
    const Scalar inverse_mass = u[3], decay = w[3];  // read once: the compiler must assume that writing w may change u
    for (int c = 0; c < 3; ++c) {
      StepForm<Kind.integrator>::advance(u[c], w[c], Drive<Scalar>{residual(c), inverse_mass, step.gravity[c], decay}, step);
    }
  }
}

}  // namespace pliant::ref
