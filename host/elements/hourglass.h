// Hourglass control of the one-point hexahedron: its record, energy and stiffness, in double.
//
// A cube of a lattice has one stiffness for its twelve hourglass modes. The record of every other hexahedron
// (kernels/elements/hex8_hourglass.cl) has, for a brick with half-lengths l_i along e_i, volume V and the material's E, nu and
// G at rest:
//   D_i = E / (1 - nu^2) V / (192 l_i^2), N_ij = nu sqrt(D_i D_j), A_i = sqrt(G V / 192) / l_i  [N/m], A [sqrt(N/m)].
// A mode q_a = xy moves the corners by h_xy q / 8, which causes e.g. the strain e_x = y / l_y q_x / (8 l_x). Over the brick,
// y / l_y has the mean square 1/3: the plane-stress energy of e_x and e_z, both linear in y, gives D and N. The shear between
// x and z, also linear in y, gives A. The shears of y with x and z are the excess of a trilinear field in bending; they are
// omitted (Belytschko and Bindeman 1993: assumed strains that vanish in bending). xyz: mean square 1/9.
//
// k, half the smallest eigenvalue of all this, acts on the modes directly, independent of the axes: D_i' = D_i - k, and so
// on, which changes nothing when undeformed. So every mode keeps some stiffness when an element is crushed.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "elements/hexahedron.h"

namespace pliant {

/// Hourglass stiffness k [N/m] of a cube of edge d, used in lattices: E d / 48 times the material's factor. One layer of
/// elements then bends as a beam of modulus E at nu = 0.
double hourglass_stiffness(const Material& material, double volume);

/// The signs of the four modes at the corners, rows xy, xz, yz, xyz.
Eigen::Matrix<double, 4, 8> hourglass_signs();

/// Numbers 24 to 54 of the record of a hexahedron: corners x [m], mean gradients [1/m] and volume [m^3]. For other shapes
/// than bricks, e_i l_i are half its mean edges and need not be orthogonal. (Orthogonal axes from the polar decomposition are
/// worse: a beam of cells sheared by 1/2 then bends 18 % too little instead of 5 %.)
std::vector<double> hourglass_numbers(const Corners8& x, const Corners8& mean, double volume, const Material& material);

/// For a record of either kind (kernels/layout.h), without fill: undeformed volume [m^3], hourglass energy [J] at the
/// displacements u, and an upper bound of its largest stiffness there [N/m], excluding that of changing axes.
double hex8_volume(std::span<const double> record);
double hourglass_energy(std::span<const double> record, const Displacements8& u);
double hourglass_bound(std::span<const double> record, const Displacements8& u);

/// gamma, rows [4][8]: q = gamma u. 0 for every linear field.
Eigen::Matrix<double, 4, 8> hourglass_vectors(std::span<const double> record);

}  // namespace pliant
