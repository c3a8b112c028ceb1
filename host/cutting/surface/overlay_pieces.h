// Pieces: the parts that the cut divides a triangle of the body's surface into.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cutting/surface/cut_sectors.h"
#include "cutting/surface/surface_crossings.h"

namespace pliant::overlay {

/// The input of pieces_of().
struct PieceSource {
  const SurfaceSource& surface;
  const CutFaces& faces;
  const SurfaceCrossings& crossings;
  const Sectors& sectors;
  const std::unordered_map<std::int32_t, std::int64_t>& vertex_cell;  ///< cut cell that holds an original vertex
};

/// Returns the pieces of an original triangle; empty if it is whole. `moved`: gets the component that carries a corner where
/// the cut of the corner's own cell decides it.
Patch pieces_of(const PieceSource& source, std::int32_t triangle, std::unordered_map<std::int32_t, Carrier>& moved);

}  // namespace pliant::overlay
