// The membrane triangle: constant strain, plane stress, the law of St Venant and Kirchhoff (kernels/links/membrane_force.cl).
// It has no stiffness against bending.
#pragma once
#include <array>
#include <span>
#include <string>

#include "geometry/mesh.h"
#include "layout.h"

namespace pliant {

struct Membrane {
  double thickness = 0;   ///< [m]
  double young = 0;       ///< [Pa]
  double poisson = 0.5;   ///< 0 <= nu <= 0.5: at 0.5 the plane law is that of an incompressible material
  double density = 1000;  ///< [kg/m^3]
  friend bool operator==(const Membrane&, const Membrane&) = default;

  /// c of the kernel [Pa].
  [[nodiscard]] double stiffness() const { return young / (1 - poisson * poisson); }

  using Record = std::array<double, PLIANT_MEMBRANE_DATA_PLANES>;
  using Corners = std::array<Vec3d, 3>;
  /// The kernel data of a triangle with these undeformed corners [m]. Throws Error, whose message begins with `what`, if its
  /// height is less than 1e-6 of its longest edge.
  [[nodiscard]] Record record(const Corners& x, const std::string& what) const;
  /// Strain energy [J] at the displacements u [m].
  [[nodiscard]] double energy(const Record& record, const Corners& u) const;
  /// An upper bound of the largest eigenvalue of its stiffness matrix at rest [N/m]: V E / (1 - nu) lambda_max(A), A = sum_a
  /// grad N_a grad N_a^T.
  [[nodiscard]] double stiffness_bound(const Record& record) const;
  /// An upper bound of the tangent modulus at the displacements u, that multiplies V A [Pa].
  [[nodiscard]] double tangent_bound(const Record& record, const Corners& u) const;
};

}  // namespace pliant
