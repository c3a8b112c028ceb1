// Energies and momenta of a state, computed in double from the Model alone, without code shared with kernels or twins.
#pragma once
#include <vector>

#include "model/model.h"

namespace pliant {

struct Energies {
  double kinetic = 0;    ///< sum m v.v / 2 [J]
  double strain = 0;     ///< of the elements, without hourglass energy [J]
  double hourglass = 0;  ///< of the hourglass modes (elements/hourglass.h) [J]
  double external = 0;   ///< potential of gravity and node forces, -R.u [J]; follower pressures have none
  [[nodiscard]] double total() const { return kinetic + strain + hourglass + external; }
};

/// The dead loads included in `external`: gravity [m/s^2], and the Model's node forces at this time [s].
struct DeadLoads {
  Vec3d gravity{};
  double time = 0;
};

/// u, v: displacement [m] and velocity [m/s] by slot, shape [Model::slots]. An element with J <= 0 yields NaN or infinity if
/// its law's energy is undefined there (host/material). Where dilation is averaged, the term in (J - 1)^2 is evaluated at the
/// nodes, with J averaged by volume over the elements of one batch at each node.
Energies energies(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v, const DeadLoads& loads = {});

/// Kinetic energy of the chosen slots, and strain and hourglass energy of the elements whose nodes are all chosen; external
/// is 0. `chosen`: shape [Model::slots].
Energies energies_among(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v,
                        const std::vector<char>& chosen);

struct Momenta {
  double mass = 0;  ///< [kg]
  Vec3d centre{};   ///< centre of mass [m]
  Vec3d linear{};   ///< [kg m/s]
  Vec3d angular{};  ///< about the origin [kg m^2/s]
};

/// With backward differences v = (u_n - u_(n-1)) / h, central differences conserve both momenta of a free body to rounding
/// error.
Momenta momenta(const Model& model, const std::vector<Vec3d>& u, const std::vector<Vec3d>& v);

/// Converts values by body and node (Simulation::displacements, velocities) to values by slot; 0 for slots without a node.
std::vector<Vec3d> by_slot(const Model& model, const std::vector<std::vector<Vec3d>>& bodies);

}  // namespace pliant
