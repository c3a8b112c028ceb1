// The Program of the embedded surface. It extends the Program of the steps, so that either can be replaced separately.
#pragma once
#include "model/model.h"
#include "program/program.h"

namespace pliant {

/// Computes the positions of the surface vertices in surface_x from node_u of `steps`. Empty without a surface. If pressures
/// already use surface_x in the steps, its pass is part of both. With `before` and `changes`, the surface is that of `before`
/// after an edit: the contents of its buffers are moved, only the listed entries are rewritten, and Buffer::changed lists
/// them.
Program surface_program(const ModelSurface& surface, const Program& steps, Program* before = nullptr,
                        const SurfaceChanges* changes = nullptr);

}  // namespace pliant
