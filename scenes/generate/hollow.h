// Solid bodies made into shells.
#pragma once
#include "geometry/mesh.h"

namespace pliant {

/// The closed surface `solid` with a cavity at least `wall` [m] away from it: the set of that depth, as a surface net of edge
/// `step` [m] that is wound inwards. Of several cavities the largest one remains. Throws Error where the body is nowhere that
/// thick.
TriangleMesh make_hollow(const TriangleMesh& solid, double wall, double step);

}  // namespace pliant
