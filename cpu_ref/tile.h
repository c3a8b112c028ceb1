// Access to tiled arrays (kernels/layout.h) and fault marks in the twins.
#pragma once
#include <cstdint>

#include "layout.h"

namespace pliant::ref {

/// Position of element e in plane 0 of an array of `planes` planes.
constexpr std::int64_t tile_base(std::int64_t e, std::int64_t planes) {
  return e / PLIANT_TILE * planes * PLIANT_TILE + e % PLIANT_TILE;
}

/// Records the step of the first fault, counted from 1, negated while the element is only inverted. kind: fault_of (law.h).
inline void mark_fault(std::int32_t kind, std::int32_t step, std::int32_t& fault) {
  if (kind > 1 && fault <= 0) fault = step + 1;
  if (kind == 1 && fault == 0) fault = -step - 1;
}

/// Element at index k of a pass over a list of tiles (Pass::active).
inline std::int64_t listed(const std::int32_t* list, std::int64_t k) {
  return std::int64_t{list[k / PLIANT_TILE]} * PLIANT_TILE + k % PLIANT_TILE;
}

}  // namespace pliant::ref
