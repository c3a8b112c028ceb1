// Twin of kernels/elements/tled_hex8_force.cl.
#include "cpu_ref/elements/hex8.h"
#include "cpu_ref/elements/hex8_hourglass.h"
#include "cpu_ref/laws/law.h"
#include "cpu_ref/laws/viscous.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

/// One stiffness for all modes, whose vectors are in the record.
template <class Scalar>
void add_hourglass_of_cube(const Corners<Scalar>& u, const HexRecord<Scalar, true>& data, Scalar k, Corners<Scalar>& f) {
  constexpr int gamma = 24;
  for (int mode = 0; mode < 4; ++mode) {  // each corner adds the modes in ascending order
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
}

/// Corner forces of the hourglass control; the part through the displacement gradient is added to the stress.
template <class Scalar>
Corners<Scalar> hourglass_of_shape(const Corners<Scalar>& u, const HexRecord<Scalar, false>& data, Scalar fill,
                                   const Mat3<Scalar>& h, Mat3<Scalar>& p) {
  const Modes<Scalar> x = modes_of(u.x), y = modes_of(u.y), z = modes_of(u.z);
  std::array<Vec3<Scalar>, 4> q;
  for (std::size_t a = 0; a < 4; ++a) q[a] = {x[a], y[a], z[a]};
  hourglass(q, h, p, fill, data);
  return {modes_back(q[0][0], q[1][0], q[2][0], q[3][0]), modes_back(q[0][1], q[1][1], q[2][1], q[3][1]),
          modes_back(q[0][2], q[1][2], q[2][2], q[3][2])};
}

}  // namespace

template <class Scalar, int Number, bool Uniform, bool Viscous>
void tled_hex8_force(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                     const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                     const Scalar* viscosity, const Scalar* node_w, const Scalar* step_params, std::int32_t corner_base,
                     std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  [[maybe_unused]] const Viscosity<Scalar> viscous(viscosity, step_params);
  constexpr int volume = Uniform ? 56 : 55;  // index of the volume in the record
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const HexRecord<Scalar, Uniform> data(hex_data, e, PLIANT_HEX_DATA_PLANES);
    const Corners<Scalar> u = hex8_displacements(e, node_u, hex_nodes);
    const Mat3<Scalar> h = hex8_gradient(u, data, 0);
    const Deformation<Scalar> d = deformation_of(h);
    const Scalar fill = hex_fill[e];
    mark_fault(fill > Scalar(0) ? fault_of(law, d) : no_fault, step, fault[fault_base + e]);
    Mat3<Scalar> p = law.stress(d, fill * data[volume], law.pressure(d.j), is_low(law, d));
    if constexpr (Viscous)
      viscous.add(p, h, hex8_gradient(hex8_displacements(e, node_w, hex_nodes), data, 0), fill * data[volume]);
    Corners<Scalar> f;
    if constexpr (!Uniform) f = hourglass_of_shape(u, data, fill, h, p);
    for (std::size_t a = 0; a < 8; ++a) {
      const auto b = 3 * static_cast<std::int64_t>(a);
      const Scalar bx = data[b], by = data[b + 1], bz = data[b + 2];
      if constexpr (Uniform) {
        f.x[a] = dot3(p.m00, bx, p.m01, by, p.m02, bz);
        f.y[a] = dot3(p.m10, bx, p.m11, by, p.m12, bz);
        f.z[a] = dot3(p.m20, bx, p.m21, by, p.m22, bz);
      } else {
        f.x[a] = add_dot3(f.x[a], p.m00, bx, p.m01, by, p.m02, bz);
        f.y[a] = add_dot3(f.y[a], p.m10, bx, p.m11, by, p.m12, bz);
        f.z[a] = add_dot3(f.z[a], p.m20, bx, p.m21, by, p.m22, bz);
      }
    }
    if constexpr (Uniform) add_hourglass_of_cube(u, data, fill * data[57], f);
    hex8_store(f, e, corner_force + corner_base);
  }
}

void register_tled_hex8_force(Registry& registry) {
  registry.add_specialised<law_count, 2, 2>("tled_hex8_force", {"LAW", "UNIFORM", "VISCOUS"},
                                            [](auto scalar, auto law, auto uniform, auto viscous) {
                                              return tled_hex8_force<decltype(scalar), law(), uniform() != 0, viscous() != 0>;
                                            });
}

}  // namespace pliant::ref
