// Twin of kernels/elements/tled_tet4_dilation.cl.
#include "cpu_ref/elements/tet4.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void tled_tet4_dilation(Range range, const Scalar* node_u, const std::int32_t* tet_nodes, const Scalar* tet_data,
                        Scalar* anp_dilation) {
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    Tet4Corners<Scalar> u;
    tet4_gather(node_u, tet_nodes + 4 * tile, u);
    Scalar dilation[PLIANT_TILE];
    for (int e = 0; e < PLIANT_TILE; ++e) {
      const Tet4<Scalar> t = tet4_load(u, tet_data + PLIANT_TET_DATA_PLANES * tile, e);
      dilation[e] = t.volume * deformation_of(t.h).j;
    }
    for (int e = 0; e < PLIANT_TILE; ++e) anp_dilation[tile + e] = dilation[e];
  }
}

void register_tled_tet4_dilation(Registry& registry) {
  registry.add("tled_tet4_dilation", tled_tet4_dilation<float>, tled_tet4_dilation<double>);
}

}  // namespace pliant::ref
