// Selections resolved to slots and triangles: fixed and prescribed nodes, forces, pressures.
#pragma once
#include "model/model.h"

namespace pliant {

/// Fill model.curves, constraints, forces and pressures. Throws Error when a selection matches nothing (says where the body is)
/// or a node index is out of range.
void add_boundary_conditions(const Scene& scene, Model& model);

/// Nodes of a body that a selection chooses, ascending. Throws Error as add_boundary_conditions does.
enum class Virtual { with_anchors, never };
std::vector<std::int32_t> select_nodes(const Selection& where, const ModelBody& body, Virtual rule);

/// Whether that looks at the model's surface.
bool needs_surface(const Scene& scene);

}  // namespace pliant
