// Points of a tool that are looked for inside tissue.
#pragma once
#include <vector>

#include "model/contact/contact.h"

namespace pliant {

/// Points of a shape in its own frame: the centre of a sphere, some of the axis of a capsule, 27 of a box, vertices of a mesh,
/// none of a half space. `most`: of an axis or a mesh, at least 2.
std::vector<Vec3d> tool_samples(const ToolForm& form, const ToolMoment& moment, std::size_t most);

}  // namespace pliant
