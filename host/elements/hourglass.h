// Hourglass control of the hexahedron with one point: the numbers of its record, its energy and its stiffness, in double.
//
// A cube of a lattice has one stiffness for its twelve hourglass modes. The record of every other hexahedron
// (kernels/elements/hex8_hourglass.cl) has, for a brick with half-lengths l_i along e_i, volume V and the material's E, nu and
// G at rest:
//   D_i = E / (1 - nu^2) V / (192 l_i^2), N_ij = nu sqrt(D_i D_j), A_i = sqrt(G V / 192) / l_i  [N/m], A [sqrt(N/m)].
// A mode q_a = xy moves the corners by h_xy q / 8, hence e.g. strains e_x = y / l_y q_x / (8 l_x). Over the brick y / l_y has
// the mean square 1/3: the energy of e_x and e_z, both linear in y, in plane stress is that of D and N. So is that of the shear
// between x and z, linear in y, with A. The shears of y with x and z are what a trilinear field has too much in bending; they
// are left out (Belytschko and Bindeman 1993: assumed strains that vanish in bending). xyz: mean square 1/9.
//
// k = half the smallest eigenvalue of all this goes to the modes as they are, whatever happens to the axes: D_i' = D_i - k, and
// so on, which at rest changes nothing. So no mode is without stiffness where an element is crushed.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "elements/hexahedron.h"

namespace pliant {

/// Hourglass stiffness k [N/m] of a cube of edge d: E d / 48 times the material's factor, which makes one layer of elements
/// bend as a beam of modulus E at nu = 0. Lattices have it.
double hourglass_stiffness(const Material& material, double volume);

/// The signs of the four modes at the corners, rows xy, xz, yz, xyz.
Eigen::Matrix<double, 4, 8> hourglass_signs();

/// Numbers 24 to 54 of the record of a hexahedron: corners x [m], mean gradients [1/m] and volume [m^3]. Where it is no brick,
/// e_i l_i are half its edges on average: they need not be orthogonal. (Orthogonal axes, those of the polar decomposition, are
/// worse: a beam of cells sheared by 1/2 then bends 18 % too little, not 5 %.)
std::vector<double> hourglass_numbers(const Corners8& x, const Corners8& mean, double volume, const Material& material);

/// Of a record of either kind (kernels/layout.h): volume at rest [m^3], hourglass energy [J] at the displacements u, and an
/// upper bound of its largest stiffness there [N/m], that of changing axes left out. All without fill.
double hex8_volume(std::span<const double> record);
double hourglass_energy(std::span<const double> record, const Displacements8& u);
double hourglass_bound(std::span<const double> record, const Displacements8& u);

/// gamma, rows [4][8]: q = gamma u. 0 for every linear field.
Eigen::Matrix<double, 4, 8> hourglass_vectors(std::span<const double> record);

}  // namespace pliant
