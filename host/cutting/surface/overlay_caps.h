// Caps: the part of each cut face that lies inside the body, for both of its sides.
#pragma once
#include <cstdint>
#include <vector>

#include "cutting/surface/cut_sectors.h"
#include "cutting/surface/surface_crossings.h"

namespace pliant::overlay {

/// Triangulates the part of a face inside the body: CutFace::nodes and CutFace::cap. Its segments are known.
void make_cap(SurfaceSource& source, CutFaces& faces, const SurfaceCrossings& crossings, std::int32_t face,
              const GridIndex& cell);

/// Returns both caps of a face, the back's first; empty if it is gone or outside the body.
Patch caps_of(const CutFaces& faces, const Sectors& sectors, std::int32_t face);

}  // namespace pliant::overlay
