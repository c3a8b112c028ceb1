// Common end of every update: external loads and a step of the integrator.
#pragma once
#include <cstdint>

#include "cpu_ref/nodes/integrator.h"
#include "cpu_ref/texels.h"

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

/// The same for the 16 nodes from i on; f: x, y and z components. `unroll 1`: texels.h.
template <UpdateKind Kind, class Scalar>
inline void integrate_row(const Scalar (&f)[3][PLIANT_TILE], Scalar* node_u, Scalar* node_w, const Scalar* node_load,
                          Scalar* node_force, const StepParameters<Scalar>& step, std::int64_t i) {
  SortedTexels<Scalar> u, w;
  Scalar residual[3][PLIANT_TILE];
  for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 1
    for (int l = 0; l < PLIANT_TILE; ++l) residual[c][l] = Kind.has_load ? node_load[4 * (i + l) + c] - f[c][l] : -f[c][l];
  }
  if constexpr (Kind.force_only) {
#pragma GCC unroll 1
    for (int l = 0; l < PLIANT_TILE; ++l) {
      Scalar* out = node_force + 4 * (i + l);
      out[0] = residual[0][l];
      out[1] = residual[1][l];
      out[2] = residual[2][l];
      out[3] = Scalar(0);
    }
  } else {
    load_texels(node_u + 4 * i, u);
    load_texels(node_w + 4 * i, w);
    for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 1
      for (int l = 0; l < PLIANT_TILE; ++l) {
        StepForm<Kind.integrator>::advance(u[c][l], w[c][l], Drive<Scalar>{residual[c][l], u[3][l], step.gravity[c], w[3][l]},
                                           step);
      }
    }
    store_texels(u, node_u + 4 * i);
    store_texels(w, node_w + 4 * i);
  }
}

}  // namespace pliant::ref
