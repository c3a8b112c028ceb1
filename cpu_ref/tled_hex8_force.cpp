// Twin of kernels/tled_hex8_force.cl.
#include "hex8.h"
#include "law.h"
#include "registry.h"

namespace pliant::ref {

template <class Scalar, int Number, bool Uniform>
void tled_hex8_force(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                     const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                     std::int32_t corner_base, std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  constexpr int gamma = 24, volume = 56, stiffness = 57;  // where they stand in the record
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const HexRecord<Scalar, Uniform> data(hex_data, e, PLIANT_HEX_DATA_PLANES);
    const Corners<Scalar> u = hex8_displacements(e, node_u, hex_nodes);
    const Deformation<Scalar> d = deformation_of(hex8_gradient(u, data, 0));
    const Scalar fill = hex_fill[e];
    mark_fault(fill > Scalar(0) ? fault_of(law, d) : no_fault, step, fault[fault_base + e]);
    const Mat3<Scalar> p = law.stress(d, fill * data[volume], law.pressure(d.j));

    Corners<Scalar> f;
    for (std::size_t a = 0; a < 8; ++a) {
      const auto b = 3 * static_cast<std::int64_t>(a);
      const Scalar bx = data[b], by = data[b + 1], bz = data[b + 2];
      f.x[a] = dot3(p.m00, bx, p.m01, by, p.m02, bz);
      f.y[a] = dot3(p.m10, bx, p.m11, by, p.m12, bz);
      f.z[a] = dot3(p.m20, bx, p.m21, by, p.m22, bz);
    }
    const Scalar k = fill * data[stiffness];
    for (int mode = 0; mode < 4; ++mode) {  // each corner takes the modes in ascending order
      Scalar qx = 0, qy = 0, qz = 0;
      for (std::size_t a = 0; a < 8; ++a) {
        const Scalar g = data[gamma + 8 * mode + static_cast<std::int64_t>(a)];
        qx = std::fma(g, u.x[a], qx);
        qy = std::fma(g, u.y[a], qy);
        qz = std::fma(g, u.z[a], qz);
      }
      const Scalar kx = k * qx, ky = k * qy, kz = k * qz;
      for (std::size_t a = 0; a < 8; ++a) {
        const Scalar g = data[gamma + 8 * mode + static_cast<std::int64_t>(a)];
        f.x[a] = std::fma(g, kx, f.x[a]);
        f.y[a] = std::fma(g, ky, f.y[a]);
        f.z[a] = std::fma(g, kz, f.z[a]);
      }
    }
    hex8_store(f, e, corner_force + corner_base);
  }
}

void register_tled_hex8_force(Registry& registry) {
  registry.add_specialised<law_count, 2>("tled_hex8_force", {"LAW", "UNIFORM"}, [](auto scalar, auto law, auto uniform) {
    return tled_hex8_force<decltype(scalar), law(), uniform() != 0>;
  });
}

}  // namespace pliant::ref
