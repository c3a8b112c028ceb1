// The links of a scene. Private to host/model.
#pragma once
#include "model/nodes/node_numbering.h"

namespace pliant {

/// Adds the springs of a mass-spring body along the edges of its tetrahedra. A stiffness, damper or force that the scene gives
/// belongs to an uncut edge: each tetrahedron at it has a share by its volume, a copy of a cut one times its fill, so that the
/// springs of both sides add up to it. `auto`: k = E sum of V / l^2 over the tetrahedra (Van Gelder 1998).
void add_mass_springs(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model);

/// Adds the springs of Body::springs. One breaks where a cut or a tear parts the elements on its line at rest. Throws Error
/// (bad_input) for nodes that do not exist or are at one place.
void add_spring_lists(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model);

/// Adds bars along the vessels of a body, k = E A / l, between points that move with the elements that hold them at rest, and
/// their mass. A segment is halved until the elements of both ends of each bar touch. The model of a cut or torn body has no
/// bar where its two elements have come apart. Throws Error (bad_input) for a point outside an uncut body.
void add_vessels(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model);

/// Adds the springs of Scene::joins between the nodes that the bodies had before cuts, without those that are broken. Throws
/// Error (bad_input).
void add_joins(const Scene& scene, Model& model);

/// Takes all links into Model::element_bound and Model::shortest: the squared frequency is at most the largest sum of 2 k over
/// mass at a node (Gershgorin), in addition to that of the elements at it.
void note_link_bounds(Model& model);

}  // namespace pliant
