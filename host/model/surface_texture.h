// Texture coordinates of the surface as it is cut now.
#pragma once
#include <vector>

#include "geometry/texture.h"
#include "model/model.h"

namespace pliant {

/// Per triangle of the surface; empty if the file of no body has any. A triangle that a cut made of a part of another one has
/// the coordinates that are affine on that one, at rest. Faces of cuts, triangles that close holes, and bodies without
/// coordinates have 0, 0.
std::vector<TextureCorners> texture_of(const Model& model);

}  // namespace pliant
