// Ballast: inertia added to single nodes during a run so that the elements there are stable at the step. This is conventional
// mass scaling, but only for the few elements whose deformation requires it (Olovsson, Simonsson, Unosson 2005 compare
// variants). It has no weight.
#pragma once
#include <span>
#include <vector>

#include "model/model.h"

namespace pliant {

/// Adds this inertia to the masses of `model`, replacing the previous ballast, and rebuilds the boundary conditions.
/// `ballast`: ascending slots of nodes.
void set_ballast(const Scene& scene, Model& model, std::span<const NodeInertia> ballast);

/// Returns an upper bound of the stiffness at each node for the displacements `u` [slots][4] (node_u): the sum over its
/// elements of the largest eigenvalue of the tangent [N/m]; 0 without finite elements. The highest squared angular frequency
/// is at most the largest ratio of stiffness to mass. `wanted` [slots]: only these nodes are computed, the others are 0;
/// empty: all. `quick`: uses the norm of the tangent instead of its eigenvalue, which takes a sixth of the time; rubber with
/// Poisson's ratio 0.3 then appears a fifth stiffer.
std::vector<double> nodal_stiffness(const Model& model, const std::vector<double>& u, const std::vector<char>& wanted = {},
                                    bool quick = false);

/// Returns 2 over the highest frequency that these stiffnesses allow [s]; 0 without elements.
double stiffness_bound(const Model& model, const std::vector<double>& stiffness);

/// Returns the slot whose stiffness limits that; 0 without elements.
std::size_t stiffest_node(const Model& model, const std::vector<double>& stiffness);

/// Returns the ballast with which every node is stable at the step `dt` [s]. A node that is too light gets half as much
/// again, for reserve; ballast of more than twice the need is reduced to twice the need. Ascending slots.
std::vector<NodeInertia> wanted_ballast(const Model& model, const std::vector<double>& stiffness, double dt);

}  // namespace pliant
