// Triangle meshes from implicit functions, for the generated organs.
#pragma once
#include <functional>

#include "geometry/mesh.h"
#include "geometry/vec.h"

namespace pliant {

/// Negative inside. It need not be a distance, but its gradient must not vanish on the surface.
using Implicit = std::function<double(const Vec3d&)>;

/// Naive surface nets: one vertex per grid cell that the surface crosses (the mean of its edge crossings, then moved onto the
/// surface along the gradient), one quad per crossed grid edge, split along its shorter diagonal. Closed and outward if `box`
/// holds the whole body and no feature is thinner than two cells of edge `step` [m].
TriangleMesh surface_nets(const Implicit& body, const vec::Box& box, double step);

}  // namespace pliant
