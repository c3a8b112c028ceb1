// Offsets of the element batches inside the buffers that all batches share.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "layout.h"
#include "model/model.h"

namespace pliant {

/// Elements of a batch, rounded up to whole tiles.
inline std::int32_t padded(std::size_t count) {
  return static_cast<std::int32_t>((count + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE);
}

/// Position of plane 0 of element e in a tiled array.
inline std::size_t tile_base(std::size_t e, std::size_t planes) {
  return e / PLIANT_TILE * (planes * PLIANT_TILE) + e % PLIANT_TILE;
}

struct BatchOffsets {
  std::int32_t corner_base = 0;  ///< first number of its part of corner_force
  std::int32_t fault_base = 0;   ///< first entry of its part of fault
};

struct ProgramLayout {
  std::vector<BatchOffsets> batches, flsm;  ///< of Model::batches and Model::flsm
  std::int32_t corner_numbers = 0;          ///< all corner forces; a further row of -0 stands behind them
  std::int32_t faults = 0;
};

/// Bricks come first in `fault` (256 entries each), then the lists of elements, then nodes of shape matching, batch by batch.
ProgramLayout lay_out(const Model& model);

}  // namespace pliant
