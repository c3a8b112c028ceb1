// Points of a tool that are looked for inside tissue.
#pragma once
#include <vector>

#include "geometry/vec.h"
#include "model/contact/contact.h"

namespace pliant {

/// Points of a shape in its own frame: the centre of a sphere, some of the axis of a capsule, 27 of a box, vertices of a mesh,
/// none of a half space. `most`: of an axis or a mesh, at least 2.
std::vector<Vec3d> tool_samples(const ToolForm& form, const ToolMoment& moment, std::size_t most);

/// Points of a shape that are within a box, in its own frame: of a round one on its centre or axis, of a box and a mesh on
/// their surfaces, at most `most` of a mesh; none of a half space or a face. No part of an edge longer than `apart` [m] is
/// left out, as far as `most` allows.
std::vector<Vec3d> tool_samples_in(const ToolForm& form, const ToolMoment& moment, const vec::Box& box, double apart,
                                   std::size_t most);

}  // namespace pliant
