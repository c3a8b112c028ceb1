// The last lines of every update: external loads and central differences (the formulas are in kernels/node_update.cl).
#pragma once
#include <cmath>
#include <cstdint>

namespace pliant::ref {

/// What the defines of an update kernel choose.
struct UpdateKind {
  bool has_load = false;    ///< R comes from node_load
  bool force_only = false;  ///< write R - F to node_force and leave the node where it is
  bool textbook = false;    ///< node_w holds u_(n-1)
};

/// What all nodes of a pass share.
template <class Scalar>
struct StepParameters {
  Scalar half_hh, gravity[3], still, fine, anchor;
  explicit StepParameters(const Scalar* step_params)
      : half_hh((Scalar(0.5) * step_params[0]) * step_params[0]),
        gravity{step_params[1], step_params[2], step_params[3]},
        still(step_params[4]),
        fine(step_params[5]),
        anchor(Scalar(3) * step_params[5]) {}
  /// None where it is too small.
  Scalar increment(Scalar w) const { return std::fabs(w) < still ? Scalar(0) : w; }
  /// On the grid where it is small.
  Scalar displacement(Scalar u) const { return std::fabs(u) < fine ? (u + anchor) - anchor : u; }
};

/// Advance node i under the summed element force f.
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
    const Scalar inverse_mass = u[3], a = w[3];
    const Scalar b = std::fma(step.half_hh, a, step.half_hh);
    const Scalar bm = b * inverse_mass;
    const Scalar free = inverse_mass > Scalar(0) ? b : Scalar(0);  // slots without a node stay where they are
    for (int c = 0; c < 3; ++c) {
      const Scalar push = std::fma(bm, residual(c), free * step.gravity[c]);
      if constexpr (Kind.textbook) {
        const Scalar next = std::fma(-a, w[c], std::fma(Scalar(1) + a, u[c], push));
        w[c] = u[c];
        u[c] = next;
      } else {
        w[c] = step.increment(std::fma(a, w[c], push));
        u[c] = step.displacement(u[c] + w[c]);
      }
    }
  }
}

}  // namespace pliant::ref
