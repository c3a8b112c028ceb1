// The surface of a cut mesh of tetrahedra: boundary faces divided where a cut meets them, and the faces of the cut on both
// sides. Everything follows the division of the tetrahedra (cut_cell.h), so the surface is closed and volumes add up exactly;
// it is a function of the cut alone.
#pragma once
#include "cutting/topology/cut_topology.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// Put the divided and capped surface of the uncut body, a volume mesh of tetrahedra, in place of the one that `solid` has. The
/// vertices of `uncut` keep their numbers; a triangle that is whole, or one piece of it, keeps its own.
void cut_tet_surface(const CutTopology& cut, const BodyMesh& uncut, BodySurface& solid);

}  // namespace pliant
