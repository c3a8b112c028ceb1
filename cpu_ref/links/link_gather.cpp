// Twin of kernels/links/link_gather.cl.
#include <cmath>

#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar>
void link_gather(Range range, Scalar* node_load, const std::int32_t* gather_node, const std::int32_t* gather_offset,
                 const std::int32_t* gather_index, const Scalar* gather_weight, const Scalar* link_force) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t node = gather_node[i];
    if (node < 0) continue;
    Scalar* load = node_load + std::int64_t{4} * (node / 2);
    Scalar f[3] = {0, 0, 0};
    for (int c = 0; node % 2 > 0 && c < 3; ++c) f[c] = load[c];
    const std::int64_t last = gather_offset[i / PLIANT_TILE + 1];
    for (std::int64_t k = gather_offset[i / PLIANT_TILE]; k < last; ++k) {
      const std::int64_t at = k * PLIANT_TILE + i % PLIANT_TILE;
      const Scalar* of = link_force + gather_index[at];
      for (int c = 0; c < 3; ++c) f[c] = std::fma(gather_weight[at], of[c * PLIANT_TILE], f[c]);
    }
    for (int c = 0; c < 3; ++c) load[c] = f[c];
  }
}

void register_link_gather(Registry& registry) { registry.add("link_gather", link_gather<float>, link_gather<double>); }

}  // namespace pliant::ref
