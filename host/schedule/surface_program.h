// The Program that places the embedded surface. It is an extension of the Program of the steps, so that either can be replaced
// without the other.
#pragma once
#include "model/model.h"
#include "program/program.h"

namespace pliant {

/// Positions of the surface's vertices into surface_x, from node_u of `steps`. Empty without a surface. Where pressures have
/// surface_x in the steps already, its pass stands there and here.
/// With `before` and `changes`, the surface is that of `before` after an edit: its numbers are moved over, only those listed
/// are written, and Buffer::changed names them.
Program surface_program(const ModelSurface& surface, const Program& steps, Program* before = nullptr,
                        const SurfaceChanges* changes = nullptr);

}  // namespace pliant
