// Twin of kernels/tled_tet4_dilation.cl.
#include "registry.h"
#include "tet4.h"

namespace pliant::ref {

template <class Scalar>
void tled_tet4_dilation(Range range, const Scalar* node_u, const std::int32_t* tet_nodes, const Scalar* tet_data,
                        Scalar* anp_dilation) {
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const Tet4<Scalar> t = tet4_load(e, node_u, tet_nodes, tet_data);
    anp_dilation[e] = t.volume * deformation_of(t.h).j;
  }
}

void register_tled_tet4_dilation(Registry& registry) {
  registry.add("tled_tet4_dilation", tled_tet4_dilation<float>, tled_tet4_dilation<double>);
}

}  // namespace pliant::ref
