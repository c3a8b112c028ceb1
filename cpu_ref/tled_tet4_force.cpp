// Twin of kernels/tled_tet4_force.cl.
#include "law.h"
#include "registry.h"
#include "tet4.h"

namespace pliant::ref {

template <class Scalar, int Law, bool Averaged>
void tled_tet4_force(Range range, const Scalar* node_u, const std::int32_t* tet_nodes, const Scalar* tet_data,
                     const Scalar* anp_pressure, Scalar* corner_force, std::int32_t* fault, Scalar p0, Scalar p1,
                     std::int32_t corner_base, std::int32_t fault_base, std::int32_t step) {
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const Tet4<Scalar> t = tet4_load(e, node_u, tet_nodes, tet_data);
    const Deformation<Scalar> d = deformation_of(t.h);
    mark_fault(is_faulty(d), step, fault[fault_base + e]);
    Scalar pressure = p1 * d.j;
    if constexpr (Averaged) {
      const std::int32_t* nodes = tet_nodes + tile_base(e, 4);
      pressure = Scalar(0.25) * ((anp_pressure[nodes[0]] + anp_pressure[nodes[PLIANT_TILE]]) +
                                 (anp_pressure[nodes[2 * PLIANT_TILE]] + anp_pressure[nodes[3 * PLIANT_TILE]]));
    }
    const Mat3<Scalar> p = law_stress<Law>(d, t.volume, p0, p1, pressure);
    const Scalar f1x = dot3(p.m00, t.b1x, p.m01, t.b1y, p.m02, t.b1z);
    const Scalar f1y = dot3(p.m10, t.b1x, p.m11, t.b1y, p.m12, t.b1z);
    const Scalar f1z = dot3(p.m20, t.b1x, p.m21, t.b1y, p.m22, t.b1z);
    const Scalar f2x = dot3(p.m00, t.b2x, p.m01, t.b2y, p.m02, t.b2z);
    const Scalar f2y = dot3(p.m10, t.b2x, p.m11, t.b2y, p.m12, t.b2z);
    const Scalar f2z = dot3(p.m20, t.b2x, p.m21, t.b2y, p.m22, t.b2z);
    const Scalar f3x = dot3(p.m00, t.b3x, p.m01, t.b3y, p.m02, t.b3z);
    const Scalar f3y = dot3(p.m10, t.b3x, p.m11, t.b3y, p.m12, t.b3z);
    const Scalar f3z = dot3(p.m20, t.b3x, p.m21, t.b3y, p.m22, t.b3z);
    Scalar* out = corner_force + corner_base + tile_base(e, PLIANT_TET_FORCE_PLANES);
    out[0 * PLIANT_TILE] = -((f1x + f2x) + f3x);
    out[1 * PLIANT_TILE] = -((f1y + f2y) + f3y);
    out[2 * PLIANT_TILE] = -((f1z + f2z) + f3z);
    out[3 * PLIANT_TILE] = f1x;
    out[4 * PLIANT_TILE] = f1y;
    out[5 * PLIANT_TILE] = f1z;
    out[6 * PLIANT_TILE] = f2x;
    out[7 * PLIANT_TILE] = f2y;
    out[8 * PLIANT_TILE] = f2z;
    out[9 * PLIANT_TILE] = f3x;
    out[10 * PLIANT_TILE] = f3y;
    out[11 * PLIANT_TILE] = f3z;
  }
}

void register_tled_tet4_force(Registry& registry) {
  registry.add_specialised<law_count, 2>("tled_tet4_force", {"LAW", "AVERAGED"}, [](auto scalar, auto law, auto averaged) {
    return tled_tet4_force<decltype(scalar), law(), averaged() != 0>;
  });
}

}  // namespace pliant::ref
