// Twin of kernels/elements/tled_hex8full_force.cl.
#include <algorithm>

#include "cpu_ref/elements/hex8.h"
#include "cpu_ref/laws/law.h"
#include "cpu_ref/laws/viscous.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar, int Number, bool Uniform, bool Viscous>
void tled_hex8full_force(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                         const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                         const Scalar* viscosity, const Scalar* node_w, const Scalar* step_params, std::int32_t corner_base,
                         std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  [[maybe_unused]] const Viscosity<Scalar> viscous(viscosity, step_params);
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const HexRecord<Scalar, Uniform> data(hex_data, e, PLIANT_HEXFULL_DATA_PLANES);
    const Corners<Scalar> u = hex8_displacements(e, node_u, hex_nodes);
    Corners<Scalar> w;
    if constexpr (Viscous) w = hex8_displacements(e, node_w, hex_nodes);
    const Scalar fill = hex_fill[e];
    Corners<Scalar> f{};
    std::int32_t kind = no_fault;
    for (std::int64_t point = 0; point < 8; ++point) {
      const std::int64_t gradients = 25 * point, weight = gradients + 24;
      const Deformation<Scalar> d = deformation_of(hex8_gradient(u, data, gradients));
      kind = std::max(kind, fill > Scalar(0) ? fault_of(law, d) : no_fault);
      Mat3<Scalar> p = law.stress(d, fill * data[weight], law.pressure(d.j), is_low(law, d));
      if constexpr (Viscous) viscous.add(p, d.h, hex8_gradient(w, data, gradients), fill * data[weight]);
      for (std::size_t a = 0; a < 8; ++a) {
        const auto b = gradients + 3 * static_cast<std::int64_t>(a);
        const Scalar bx = data[b], by = data[b + 1], bz = data[b + 2];
        f.x[a] = std::fma(p.m02, bz, std::fma(p.m01, by, std::fma(p.m00, bx, f.x[a])));
        f.y[a] = std::fma(p.m12, bz, std::fma(p.m11, by, std::fma(p.m10, bx, f.y[a])));
        f.z[a] = std::fma(p.m22, bz, std::fma(p.m21, by, std::fma(p.m20, bx, f.z[a])));
      }
    }
    mark_fault(kind, step, fault[fault_base + e]);
    hex8_store(f, e, corner_force + corner_base);
  }
}

void register_tled_hex8full_force(Registry& registry) {
  registry.add_specialised<law_count, 2, 2>(
      "tled_hex8full_force", {"LAW", "UNIFORM", "VISCOUS"}, [](auto scalar, auto law, auto uniform, auto viscous) {
        return tled_hex8full_force<decltype(scalar), law(), uniform() != 0, viscous() != 0>;
      });
}

}  // namespace pliant::ref
