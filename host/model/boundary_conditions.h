// Selections resolved to slots and triangles: fixed and prescribed nodes, forces, pressures.
#pragma once
#include "model/model.h"

namespace pliant {

/// Fill model.curves, constraints, forces and pressures. Throws Error when a selection matches nothing (says where the body is)
/// or a node index is out of range.
void add_boundary_conditions(const Scene& scene, Model& model);

/// Whether that looks at the model's surface.
bool needs_surface(const Scene& scene);

}  // namespace pliant
