// Lists of nodes as kernels/links/node_sum.cl reads them.
#pragma once
#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test {

/// [tiles][2][16] different slots below count + 20, of which some are written and some are padding, which repeats one of its
/// tile.
inline Ints random_nodes(Random& random, std::size_t count) {
  const Ints slots = random.distinct(count, count + 20);
  Ints node(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t lane = i % PLIANT_TILE, at = 2 * (i - lane) + lane;
    const bool padding = lane > 0 && random.chance(0.1);
    node[at] = padding ? node[at - 1] : slots[i];
    node[at + PLIANT_TILE] = padding ? -1 : random.integer(0, 1);
  }
  return node;
}

}  // namespace pliant::kernel_test
