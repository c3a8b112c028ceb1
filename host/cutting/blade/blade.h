// The blade: what it sweeps, and which edges of a body the sweep crosses.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"

namespace pliant {

using BladeSegment = std::array<Vec3d, 2>;   ///< both ends [m]
using SweepTriangle = std::array<Vec3d, 3>;  ///< [m]

/// What a blade sweeps between two moments: (a0, b0, b1) and (a0, b1, a1), without those in which two corners coincide. Sweeps
/// that follow each other share their corners, so nothing slips between them.
std::vector<SweepTriangle> sweep(const BladeSegment& from, const BladeSegment& to);

/// The edges that `triangles` cross and that are not cut yet, with the place where they are crossed. `x` [m] are present
/// positions; the first mesh().rest.size() of them are used: an uncut edge joins real nodes. Rule for what touches exactly:
/// positions are rounded to a grid (4e-12 of the largest coordinate's next power of two), and every point counts as moved by an
/// infinitesimal amount that depends on its number (nodes) or its coordinates (blade) alone (simulation of simplicity,
/// predicates.h). So an edge is crossed or not, the same in every cell that has it, and a point that several triangles share
/// lies in front of or behind all of them. An edge that several triangles cross is cut where the first of them crosses it.
/// Edges with a position that is not finite are left alone; triangles that are not finite are an Error.
CutEdges crossed_edges(const CutTopology& body, std::span<const Vec3d> x, std::span<const SweepTriangle> triangles);

}  // namespace pliant
