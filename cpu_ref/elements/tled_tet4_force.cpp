// Twin of kernels/elements/tled_tet4_force.cl.
#include <algorithm>
#include <type_traits>

#include "cpu_ref/elements/tet4.h"
#include "cpu_ref/laws/law.h"
#include "cpu_ref/laws/viscous.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Number, bool Averaged, bool Viscous>
void tled_tet4_force(Range range, const Scalar* node_u, const std::int32_t* tet_nodes, const Scalar* tet_data,
                     const Scalar* anp_pressure, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                     const Scalar* viscosity, const Scalar* node_w, const Scalar* step_params, std::int32_t corner_base,
                     std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  [[maybe_unused]] const Viscosity<Scalar> viscous(viscosity, step_params);
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const std::int32_t* nodes = tet_nodes + 4 * tile;
    const Scalar* data = tet_data + PLIANT_TET_DATA_PLANES * tile;
    Tet4Corners<Scalar> u;
    tet4_gather(node_u, nodes, u);
    Tet4Corners<Scalar> w;
    if constexpr (Viscous) tet4_gather(node_w, nodes, w);
    Scalar mean_pressure[PLIANT_TILE];
    for (int e = 0; Averaged && e < PLIANT_TILE; ++e) {
      const auto pressure = [&](int corner) { return anp_pressure[nodes[corner * PLIANT_TILE + e]]; };
      mean_pressure[e] = Scalar(0.25) * ((pressure(0) + pressure(1)) + (pressure(2) + pressure(3)));
    }
    Scalar f[PLIANT_TET_FORCE_PLANES][PLIANT_TILE];  // local, so that no other array can alias it
    std::int32_t fault_kind[PLIANT_TILE];
    const auto element = [&](int e, auto low) {
      const Tet4<Scalar> t = tet4_load(u, data, e);
      const Deformation<Scalar> d = deformation_of(t.h);
      fault_kind[e] = fault_of(law, d);
      Mat3<Scalar> p = law.stress(d, t.volume, Averaged ? mean_pressure[e] : law.pressure(d.j), low(d));
      if constexpr (Viscous) viscous.add(p, t.h, tet4_load(w, data, e).h, t.volume);
      f[3][e] = dot3(p.m00, t.b1x, p.m01, t.b1y, p.m02, t.b1z);
      f[4][e] = dot3(p.m10, t.b1x, p.m11, t.b1y, p.m12, t.b1z);
      f[5][e] = dot3(p.m20, t.b1x, p.m21, t.b1y, p.m22, t.b1z);
      f[6][e] = dot3(p.m00, t.b2x, p.m01, t.b2y, p.m02, t.b2z);
      f[7][e] = dot3(p.m10, t.b2x, p.m11, t.b2y, p.m12, t.b2z);
      f[8][e] = dot3(p.m20, t.b2x, p.m21, t.b2y, p.m22, t.b2z);
      f[9][e] = dot3(p.m00, t.b3x, p.m01, t.b3y, p.m02, t.b3z);
      f[10][e] = dot3(p.m10, t.b3x, p.m11, t.b3y, p.m12, t.b3z);
      f[11][e] = dot3(p.m20, t.b3x, p.m21, t.b3y, p.m22, t.b3z);
      f[0][e] = -((f[3][e] + f[6][e]) + f[9][e]);
      f[1][e] = -((f[4][e] + f[7][e]) + f[10][e]);
      f[2][e] = -((f[5][e] + f[8][e]) + f[11][e]);
      return is_low(law, d);
    };
    // Few tiles contain an element below law.low; they are computed again.
    std::int32_t low = 0;
    for (int e = 0; e < PLIANT_TILE; ++e)
      low |= static_cast<std::int32_t>(element(e, [](const auto&) { return std::false_type{}; }));
    for (int e = 0; low != 0 && e < PLIANT_TILE; ++e) element(e, [&](const auto& d) { return is_low(law, d); });
    std::copy(&f[0][0], &f[0][0] + PLIANT_TET_FORCE_PLANES * PLIANT_TILE,
              corner_force + corner_base + PLIANT_TET_FORCE_PLANES * tile);
    for (int e = 0; e < PLIANT_TILE; ++e) mark_fault(fault_kind[e], step, fault[fault_base + tile + e]);
  }
}

void register_tled_tet4_force(Registry& registry) {
  registry.add_specialised<law_count, 2, 2>("tled_tet4_force", {"LAW", "AVERAGED", "VISCOUS"},
                                            [](auto scalar, auto law, auto averaged, auto viscous) {
                                              return tled_tet4_force<decltype(scalar), law(), averaged() != 0, viscous() != 0>;
                                            });
}

}  // namespace pliant::ref
