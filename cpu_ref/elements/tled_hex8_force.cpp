// Twin of kernels/elements/tled_hex8_force.cl.
#include <algorithm>

#include "cpu_ref/elements/hex8.h"
#include "cpu_ref/elements/hex8_hourglass.h"
#include "cpu_ref/laws/law.h"
#include "cpu_ref/laws/viscous.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

/// Numbers of the 16 elements of a tile.
template <class Scalar>
using Lanes = Scalar[PLIANT_TILE];

/// Displacements and forces of the corners of a tile.
template <class Scalar>
struct TileCorners {
  Lanes<Scalar> x[8], y[8], z[8];
};

template <class Scalar>
inline void load_tile(std::int64_t tile, const Scalar* node_u, const std::int32_t* hex_nodes, TileCorners<Scalar>& u) {
  const std::int32_t* nodes = hex_nodes + tile * 8 * PLIANT_TILE;
  for (std::int64_t a = 0; a < 8; ++a) {
    for (std::int64_t l = 0; l < PLIANT_TILE; ++l) {
      const Scalar* texel = node_u + std::int64_t{4} * nodes[a * PLIANT_TILE + l];
      u.x[a][l] = texel[0];
      u.y[a][l] = texel[1];
      u.z[a][l] = texel[2];
    }
  }
}

/// f += hourglass control of one stiffness k for all modes, whose vectors are in the record; each corner adds the modes in
/// ascending order.
template <class Scalar>
[[gnu::always_inline]] inline void add_hourglass_of_cube(const TileCorners<Scalar>& u, const Scalar* gamma, Scalar k,
                                                         std::int64_t l, TileCorners<Scalar>& f) {
#pragma GCC unroll 4
  for (int mode = 0; mode < 4; ++mode) {
    Scalar qx = 0, qy = 0, qz = 0;
#pragma GCC unroll 8
    for (int a = 0; a < 8; ++a) {
      const Scalar g = gamma[8 * mode + a];
      qx = std::fma(g, u.x[a][l], qx);
      qy = std::fma(g, u.y[a][l], qy);
      qz = std::fma(g, u.z[a][l], qz);
    }
    const Scalar kx = k * qx, ky = k * qy, kz = k * qz;
#pragma GCC unroll 8
    for (int a = 0; a < 8; ++a) {
      const Scalar g = gamma[8 * mode + a];
      f.x[a][l] = std::fma(g, kx, f.x[a][l]);
      f.y[a][l] = std::fma(g, ky, f.y[a][l]);
      f.z[a][l] = std::fma(g, kz, f.z[a][l]);
    }
  }
}

/// The elements of a tile, which share their record: the compiler computes the lanes of a vector together.
template <class Scalar, int Number, bool Viscous>
void uniform_tile(const MaterialLaw<Number, Scalar>& law, const Viscosity<Scalar>& viscous, const Scalar* data,
                  const Scalar* fill, const TileCorners<Scalar>& u, const TileCorners<Scalar>& w, TileCorners<Scalar>& f,
                  Lanes<Scalar>& dilation) {
  constexpr int volume = 56, stiffness = 57, gamma = 24;
  const auto gradient = [data](const TileCorners<Scalar>& v, std::int64_t l) __attribute__((always_inline)) {
    Mat3<Scalar> h;
#pragma GCC unroll 8
    for (int a = 0; a < 8; ++a) {
      const Scalar bx = data[3 * a], by = data[3 * a + 1], bz = data[3 * a + 2];
      h.m00 = std::fma(v.x[a][l], bx, h.m00);
      h.m01 = std::fma(v.x[a][l], by, h.m01);
      h.m02 = std::fma(v.x[a][l], bz, h.m02);
      h.m10 = std::fma(v.y[a][l], bx, h.m10);
      h.m11 = std::fma(v.y[a][l], by, h.m11);
      h.m12 = std::fma(v.y[a][l], bz, h.m12);
      h.m20 = std::fma(v.z[a][l], bx, h.m20);
      h.m21 = std::fma(v.z[a][l], by, h.m21);
      h.m22 = std::fma(v.z[a][l], bz, h.m22);
    }
    return h;
  };
  for (std::int64_t l = 0; l < PLIANT_TILE; ++l) {  // vectorized in part
    const Mat3<Scalar> h = gradient(u, l);
    const Deformation<Scalar> d = deformation_of(h);
    dilation[l] = d.j;
    Mat3<Scalar> p = law.stress(d, fill[l] * data[volume], law.pressure(d.j), is_low(law, d));
    if constexpr (Viscous) viscous.add(p, h, gradient(w, l), fill[l] * data[volume]);
#pragma GCC unroll 8
    for (int a = 0; a < 8; ++a) {
      const Scalar bx = data[3 * a], by = data[3 * a + 1], bz = data[3 * a + 2];
      f.x[a][l] = dot3(p.m00, bx, p.m01, by, p.m02, bz);
      f.y[a][l] = dot3(p.m10, bx, p.m11, by, p.m12, bz);
      f.z[a][l] = dot3(p.m20, bx, p.m21, by, p.m22, bz);
    }
  }
  for (std::int64_t l = 0; l < PLIANT_TILE; ++l) add_hourglass_of_cube(u, data + gamma, fill[l] * data[stiffness], l, f);
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

/// The elements of a range that begins or ends within a tile are stored alone.
template <class Scalar, int Number, bool Viscous>
void force_of_uniform(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                      const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                      const Viscosity<Scalar>& viscous, const Scalar* node_w, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  TileCorners<Scalar> u, f;
  [[maybe_unused]] TileCorners<Scalar> w;
  Lanes<Scalar> dilation;
  for (std::int64_t tile = range.begin / PLIANT_TILE; tile * PLIANT_TILE < range.end; ++tile) {
    const std::int64_t first = tile * PLIANT_TILE;
    load_tile(tile, node_u, hex_nodes, u);
    if constexpr (Viscous) load_tile(tile, node_w, hex_nodes, w);
    uniform_tile<Scalar, Number, Viscous>(law, viscous, hex_data, hex_fill + first, u, Viscous ? w : u, f, dilation);
    Scalar* out = corner_force + tile * PLIANT_HEX_FORCE_PLANES * PLIANT_TILE;
    const std::int64_t begin = std::max(range.begin, first) - first, end = std::min(range.end, first + PLIANT_TILE) - first;
    mark_faults(law, dilation, hex_fill + first, begin, end, step, fault + first);
    for (std::int64_t a = 0; a < 8; ++a) {
      Scalar* plane = out + 3 * a * PLIANT_TILE;
      for (std::int64_t l = begin; l < end; ++l) plane[l] = f.x[a][l];
      for (std::int64_t l = begin; l < end; ++l) plane[PLIANT_TILE + l] = f.y[a][l];
      for (std::int64_t l = begin; l < end; ++l) plane[2 * PLIANT_TILE + l] = f.z[a][l];
    }
  }
}

/// A hexahedron with a record of its own.
template <class Scalar, int Number, bool Viscous>
void force_of_shapes(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                     const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                     const Viscosity<Scalar>& viscous, const Scalar* node_w, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  constexpr int volume = 55;
  for (std::int64_t e = range.begin; e < range.end; ++e) {
    const HexRecord<Scalar, false> data(hex_data, e, PLIANT_HEX_DATA_PLANES);
    const Corners<Scalar> u = hex8_displacements(e, node_u, hex_nodes);
    const Mat3<Scalar> h = hex8_gradient(u, data, 0);
    const Deformation<Scalar> d = deformation_of(h);
    const Scalar fill = hex_fill[e];
    mark_fault(fill > Scalar(0) ? fault_of(law, d) : no_fault, step, fault[e]);
    Mat3<Scalar> p = law.stress(d, fill * data[volume], law.pressure(d.j), is_low(law, d));
    if constexpr (Viscous)
      viscous.add(p, h, hex8_gradient(hex8_displacements(e, node_w, hex_nodes), data, 0), fill * data[volume]);
    Corners<Scalar> f = hourglass_of_shape(u, data, fill, h, p);
    for (std::size_t a = 0; a < 8; ++a) {
      const auto b = 3 * static_cast<std::int64_t>(a);
      const Scalar bx = data[b], by = data[b + 1], bz = data[b + 2];
      f.x[a] = add_dot3(f.x[a], p.m00, bx, p.m01, by, p.m02, bz);
      f.y[a] = add_dot3(f.y[a], p.m10, bx, p.m11, by, p.m12, bz);
      f.z[a] = add_dot3(f.z[a], p.m20, bx, p.m21, by, p.m22, bz);
    }
    hex8_store(f, e, corner_force);
  }
}

}  // namespace

template <class Scalar, int Number, bool Uniform, bool Viscous>
void tled_hex8_force(Range range, const Scalar* node_u, const std::int32_t* hex_nodes, const Scalar* hex_data,
                     const Scalar* hex_fill, Scalar* corner_force, std::int32_t* fault, const Scalar* law_parameters,
                     const Scalar* viscosity, const Scalar* node_w, const Scalar* step_params, std::int32_t corner_base,
                     std::int32_t fault_base, std::int32_t step) {
  const Viscosity<Scalar> viscous(viscosity, step_params);
  constexpr auto force = Uniform ? force_of_uniform<Scalar, Number, Viscous> : force_of_shapes<Scalar, Number, Viscous>;
  force(range, node_u, hex_nodes, hex_data, hex_fill, corner_force + corner_base, fault + fault_base, law_parameters, viscous,
        node_w, step);
}

void register_tled_hex8_force(Registry& registry) {
  registry.add_specialised<law_count, 2, 2>("tled_hex8_force", {"LAW", "UNIFORM", "VISCOUS"},
                                            [](auto scalar, auto law, auto uniform, auto viscous) {
                                              return tled_hex8_force<decltype(scalar), law(), uniform() != 0, viscous() != 0>;
                                            });
}

}  // namespace pliant::ref
