// Energies and momenta of a state, in double and from the Model alone: nothing here shares code with the kernels or their
// twins.
#pragma once
#include <vector>

#include "model/model.h"

namespace pliant {

struct Energies {
  double kinetic = 0;    ///< sum m v.v / 2 [J]
  double strain = 0;     ///< elements without their hourglass part [J]
  double hourglass = 0;  ///< of the hourglass modes of hex8 (elements/hourglass.h) [J]
  double external = 0;   ///< potential of gravity and of node forces, -R.u [J]; a follower pressure has none
  [[nodiscard]] double total() const { return kinetic + strain + hourglass + external; }
};

/// The dead loads that `external` counts: gravity [m/s^2], and the node forces of the Model at this time [s].
struct DeadLoads {
  Vec3d gravity{};
  double time = 0;
};

/// u, v: displacement [m] and velocity [m/s] by slot, [Model::slots]. An element with J <= 0 gives NaN or infinity where its
/// law has no energy there (host/material: the energies of the laws).
/// tet4anp takes the term in (J - 1)^2 at the nodes, with J averaged over the volumes of a node's elements of one batch.
Energies energies(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v, const DeadLoads& loads = {});

/// Kinetic energy of these slots and strain and hourglass energy of the elements all of whose nodes are among them; no external
/// one. `chosen`: [Model::slots].
Energies energies_among(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v,
                        const std::vector<char>& chosen);

struct Momenta {
  double mass = 0;  ///< [kg]
  Vec3d centre{};   ///< centre of mass [m]
  Vec3d linear{};   ///< [kg m/s]
  Vec3d angular{};  ///< about the origin [kg m^2/s]
};

/// With the backward differences v = (u_n - u_(n-1)) / h central differences keep both momenta of a free body to rounding
/// error.
Momenta momenta(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v);

/// Values by slot from values by body and node (Simulation::displacements, velocities); 0 where there is no node.
std::vector<Vec3d> by_slot(const Model& model, const std::vector<std::vector<Vec3d>>& bodies);

}  // namespace pliant
