// Offsets of the element batches in the shared buffers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "layout.h"
#include "model/model.h"

namespace pliant {

/// Rounds a number of elements up to whole tiles.
inline std::int32_t padded(std::size_t count) {
  return static_cast<std::int32_t>((count + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE);
}

/// Position of plane 0 of element e in a tiled array.
inline std::size_t tile_base(std::size_t e, std::size_t planes) {
  return e / PLIANT_TILE * (planes * PLIANT_TILE) + e % PLIANT_TILE;
}

struct BatchOffsets {
  std::int32_t corner_base = 0;  ///< first number of the batch in corner_force
  std::int32_t fault_base = 0;   ///< first entry of the batch in fault
};

struct ProgramLayout {
  std::vector<BatchOffsets> batches, flsm;  ///< of Model::batches and Model::flsm
  std::int32_t corner_numbers = 0;          ///< size of all corner forces; a row of -0 follows them
  std::int32_t faults = 0;
};

/// In `fault`, bricks come first (256 entries each), then element lists, then nodes of shape matching, batch by batch.
ProgramLayout lay_out(const Model& model);

}  // namespace pliant
