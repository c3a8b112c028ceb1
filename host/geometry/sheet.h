// Sheets: triangle surfaces that get a thickness, such as skin, a cloth or the wall of a vessel.
#pragma once
#include <string>

#include "geometry/mesh.h"

namespace pliant {

/// Returns one layer of tetrahedra on both sides of a surface, open or closed. Vertex v becomes the nodes 2 v and 2 v + 1, half
/// a `thickness` [m] below and above it along its normal; above is where the triangles are seen counter-clockwise. Every
/// triangle becomes a prism of three tetrahedra; where two prisms meet, the diagonal begins at the lower node of the smaller
/// index, so their faces agree. `name` is for messages. Throws Error (bad_input) where more than two triangles meet at an edge,
/// for a surface with one side, and where it bends too sharply for the thickness.
VolumeMesh thicken(TriangleMesh surface, double thickness, const std::string& name);

}  // namespace pliant
