// Twin of kernels/anp_node_pressure.cl.
#include "registry.h"
#include "tile.h"

namespace pliant::ref {

template <class Scalar>
void anp_node_pressure(Range range, const Scalar* anp_dilation, const std::int32_t* anp_offset, const std::int32_t* anp_index,
                       const Scalar* anp_inverse_volume, Scalar* anp_pressure, Scalar p1, std::int32_t node_base) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t first = anp_offset[i / PLIANT_TILE], last = anp_offset[i / PLIANT_TILE + 1];
    Scalar sum = Scalar(-0.0);
    for (std::int64_t k = first; k < last; ++k) sum += anp_dilation[anp_index[k * PLIANT_TILE + i % PLIANT_TILE]];
    anp_pressure[node_base + i] = p1 * (sum * anp_inverse_volume[i]);
  }
}

void register_anp_node_pressure(Registry& registry) {
  registry.add("anp_node_pressure", anp_node_pressure<float>, anp_node_pressure<double>);
}

}  // namespace pliant::ref
