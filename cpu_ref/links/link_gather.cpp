// Twin of kernels/links/link_gather.cl.
#include <cmath>

#include "cpu_ref/links/node_sum.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void link_gather(Range range, Scalar* node_load, const std::int32_t* gather_node, const std::int32_t* gather_offset,
                 const std::int32_t* gather_index, const Scalar* gather_weight, const Scalar* link_force) {
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const NodeSum<Scalar> nodes(gather_node, tile);
    Scalar f[3][PLIANT_TILE];
    nodes.begin(node_load, f);
    const std::int64_t last = gather_offset[tile / PLIANT_TILE + 1];
    for (std::int64_t k = gather_offset[tile / PLIANT_TILE]; k < last; ++k) {
      for (int l = 0; l < PLIANT_TILE; ++l) {  // vectorized
        const std::int64_t at = k * PLIANT_TILE + l;
        const Scalar* of = link_force + std::int64_t{4} * gather_index[at];
        for (int c = 0; c < 3; ++c) f[c][l] = std::fma(gather_weight[at], of[c], f[c][l]);
      }
    }
    nodes.store(f, node_load);
  }
}

void register_link_gather(Registry& registry) { registry.add("link_gather", link_gather<float>, link_gather<double>); }

}  // namespace pliant::ref
