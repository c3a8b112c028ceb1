// The surface swept by a blade, and the edges of a body that it crosses.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"

namespace pliant {

using BladeSegment = std::array<Vec3d, 2>;   ///< both ends [m]
using SweepTriangle = std::array<Vec3d, 3>;  ///< [m]

/// Returns the triangles that a blade sweeps between two positions, (a0, b0, b1) and (a0, b1, a1), without degenerate ones.
/// Consecutive sweeps share corners, so there is no gap between them.
std::vector<SweepTriangle> sweep(const BladeSegment& from, const BladeSegment& to);

/// Returns the uncut edges that `triangles` cross, with the crossing point. `x` [m]: current positions, of which the first
/// mesh().rest.size() are used, since an uncut edge joins real nodes. For exact touching, positions are rounded to a grid
/// (4e-12 of the largest coordinate's next power of two), and every point counts as moved by an infinitesimal amount that
/// depends only on its number (nodes) or its coordinates (blade) (simulation of simplicity, predicates.h). So whether an edge
/// is crossed is the same in every cell, and a point shared by several triangles is in front of or behind all of them. An
/// edge crossed by several triangles is cut at the first crossing. Edges with non-finite positions are skipped; non-finite
/// triangles throw Error.
CutEdges crossed_edges(const CutTopology& body, std::span<const Vec3d> x, std::span<const SweepTriangle> triangles);

}  // namespace pliant
