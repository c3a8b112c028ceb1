// Shared by the 8-node hexahedra: node displacements, the displacement gradient, the force of a stress on a corner.
#pragma once
#include <array>
#include <cstdint>

#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar>
struct Corners {
  std::array<Scalar, 8> x, y, z;
};

/// Read-only record of an element: one for all (UNIFORM) or one per element in tiles.
template <class Scalar, bool Uniform>
class HexRecord {
 public:
  HexRecord(const Scalar* hex_data, std::int64_t e, std::int64_t planes)
      : data_(Uniform ? hex_data : hex_data + tile_base(e, planes)) {}
  Scalar operator[](std::int64_t k) const { return data_[Uniform ? k : k * PLIANT_TILE]; }

 private:
  const Scalar* data_;
};

template <class Scalar>
inline Corners<Scalar> hex8_displacements(std::int64_t e, const Scalar* node_u, const std::int32_t* hex_nodes) {
  Corners<Scalar> u;
  for (std::size_t a = 0; a < 8; ++a) {
    const Scalar* texel = node_u + std::int64_t{4} * hex_nodes[tile_base(e, 8) + static_cast<std::int64_t>(a) * PLIANT_TILE];
    u.x[a] = texel[0];
    u.y[a] = texel[1];
    u.z[a] = texel[2];
  }
  return u;
}

/// H = sum_a u_a (x) b_a in ascending order from +0; b_a are the 24 numbers of the record from `first` on.
template <class Scalar, bool Uniform>
inline Mat3<Scalar> hex8_gradient(const Corners<Scalar>& u, const HexRecord<Scalar, Uniform>& data, std::int64_t first) {
  Mat3<Scalar> h;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto b = first + 3 * static_cast<std::int64_t>(a);
    const Scalar bx = data[b], by = data[b + 1], bz = data[b + 2];
    h.m00 = std::fma(u.x[a], bx, h.m00);
    h.m01 = std::fma(u.x[a], by, h.m01);
    h.m02 = std::fma(u.x[a], bz, h.m02);
    h.m10 = std::fma(u.y[a], bx, h.m10);
    h.m11 = std::fma(u.y[a], by, h.m11);
    h.m12 = std::fma(u.y[a], bz, h.m12);
    h.m20 = std::fma(u.z[a], bx, h.m20);
    h.m21 = std::fma(u.z[a], by, h.m21);
    h.m22 = std::fma(u.z[a], bz, h.m22);
  }
  return h;
}

/// Stores a force in planes 0..23 of this element: corner by corner, x, y, z.
template <class Scalar>
inline void hex8_store(const Corners<Scalar>& f, std::int64_t e, Scalar* corner_force) {
  Scalar* out = corner_force + tile_base(e, PLIANT_HEX_FORCE_PLANES);
  for (std::size_t a = 0; a < 8; ++a) {
    const auto plane = 3 * static_cast<std::int64_t>(a) * PLIANT_TILE;
    out[plane] = f.x[a];
    out[plane + PLIANT_TILE] = f.y[a];
    out[plane + 2 * PLIANT_TILE] = f.z[a];
  }
}

}  // namespace pliant::ref
