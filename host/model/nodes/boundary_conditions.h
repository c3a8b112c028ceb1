// Resolves selections to slots and triangles: fixed and prescribed nodes, forces, pressures.
#pragma once
#include "model/model.h"

namespace pliant {

/// Fills model.curves, constraints, forces and pressures. Throws Error if a selection is empty (with the bounds of the body)
/// or a node index is out of range.
void add_boundary_conditions(const Scene& scene, Model& model);

/// Returns the selected nodes of a body, ascending. Throws Error as add_boundary_conditions does.
enum class Virtual { with_anchors, never };
std::vector<std::int32_t> select_nodes(const Selection& where, const ModelBody& body, Virtual rule);

/// Returns true if add_boundary_conditions needs the model's surface.
bool needs_surface(const Scene& scene);

}  // namespace pliant
