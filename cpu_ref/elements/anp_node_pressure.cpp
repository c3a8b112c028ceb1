// Twin of kernels/elements/anp_node_pressure.cl.
#include "cpu_ref/laws/law.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar, int Number>
void anp_node_pressure(Range range, const Scalar* anp_dilation, const std::int32_t* anp_offset, const std::int32_t* anp_index,
                       const Scalar* anp_inverse_volume, Scalar* anp_pressure, const Scalar* law_parameters,
                       std::int32_t node_base) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const std::int32_t first = anp_offset[i / PLIANT_TILE], last = anp_offset[i / PLIANT_TILE + 1];
    Scalar sum = Scalar(-0.0);
    for (std::int64_t k = first; k < last; ++k) sum += anp_dilation[anp_index[k * PLIANT_TILE + i % PLIANT_TILE]];
    anp_pressure[node_base + i] = law.pressure(sum * anp_inverse_volume[i]);
  }
}

void register_anp_node_pressure(Registry& registry) {
  registry.add_specialised<law_count>("anp_node_pressure", {"LAW"},
                                      [](auto scalar, auto law) { return anp_node_pressure<decltype(scalar), law()>; });
}

}  // namespace pliant::ref
