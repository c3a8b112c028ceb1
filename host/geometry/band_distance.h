// Signed distances on a regular grid, fast enough for a surface that changes every frame.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/node_grid.h"

namespace pliant {

/// Signed distances [m] of a closed, outward surface at the nodes of a grid that encloses it. Exact at nodes up to two cells
/// from the surface. Farther outside they are too small by up to 0.75 cells, so that nothing is nearer than they say; deeper
/// inside too deep by less than a cell. Parts of the surface that overlap count as inside. The result depends neither on the
/// number of threads nor on Embree.
std::vector<double> band_distances(const TriangleMesh& mesh, const NodeGrid& grid);

/// Lowers distances at nodes so that their trilinear interpolation has the right mean over a cell: that of a curved function is
/// too high by h^2/12 of its Laplacian, which would make a ball too small. Nodes on the boundary of the grid stay.
std::vector<double> with_right_means(const std::vector<double>& exact, const std::array<std::int32_t, 3>& size);

}  // namespace pliant
