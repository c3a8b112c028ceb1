// Triangles of a tool's shape, for pictures and for measures of overlap.
#pragma once
#include "geometry/mesh.h"
#include "model/contact/contact.h"

namespace pliant {

/// A shape in its own frame, outward; nothing of a half space or a sequence. `around`: sides of round parts, a multiple of
/// four; its corners lie on the round surface.
TriangleMesh tool_mesh(const ToolForm& form, int around);

/// The same with the volume of the shape: the corners of round parts lie a little outside.
TriangleMesh tool_mesh_of_volume(const ToolForm& form, int around);

}  // namespace pliant
