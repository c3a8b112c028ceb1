// Inertia that single nodes get while a scene runs, so that the elements there stand the step: conventional mass scaling, but
// of those few elements alone whose deformation asks for it (Olovsson, Simonsson, Unosson 2005 compare it with others). It has
// no weight.
#pragma once
#include <span>
#include <vector>

#include "model/model.h"

namespace pliant {

/// Give `model` this inertia beside its masses, in place of what was given before, and its boundary conditions anew. `ballast`:
/// ascending slots of nodes.
void set_ballast(const Scene& scene, Model& model, std::span<const NodeInertia> ballast);

/// Upper bound of the stiffness that each node feels at the displacements `u` [slots][4] (node_u): over its elements, the sum
/// of the largest eigenvalue of each one's tangent [N/m]; 0 where there is no finite element. The highest squared angular
/// frequency is at most the largest stiffness over mass of a node. `wanted` [slots]: only of these nodes, 0 elsewhere; empty:
/// of all. `quick`: with the norm of the tangent in place of its eigenvalue, in a sixth of the time; rubber with a Poisson's
/// ratio of 0.3 is then a fifth stiffer.
std::vector<double> nodal_stiffness(const Model& model, const std::vector<double>& u, const std::vector<char>& wanted = {},
                                    bool quick = false);

/// 2 over the highest frequency that these stiffnesses allow [s]; 0 without elements.
double stiffness_bound(const Model& model, const std::vector<double>& stiffness);

/// The ballast with which every node stands the step `dt` [s]. What is too light gets half as much again, so that it
/// lasts; what has twice as much as it needs gives it back down to that. Ascending slots.
std::vector<NodeInertia> wanted_ballast(const Model& model, const std::vector<double>& stiffness, double dt);

}  // namespace pliant
