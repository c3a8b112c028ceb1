// Displacement gradient of a linear tetrahedron: H = sum_a (u_a - u_0) (x) grad N_a, a = 1..3.
#pragma once
#include <cstdint>

#include "deformation.h"
#include "tile.h"

namespace pliant::ref {

template <class Scalar>
struct Tet4 {
  Mat3<Scalar> h;                                      ///< [1]
  Scalar b1x, b1y, b1z, b2x, b2y, b2z, b3x, b3y, b3z;  ///< grad N_1..3 [1/m]
  Scalar volume;                                       ///< [m^3]
};

template <class Scalar>
inline Tet4<Scalar> tet4_load(std::int64_t e, const Scalar* node_u, const std::int32_t* tet_nodes, const Scalar* tet_data) {
  const std::int32_t* nodes = tet_nodes + tile_base(e, 4);
  const Scalar* u0 = node_u + std::int64_t{4} * nodes[0];
  const Scalar* u1 = node_u + std::int64_t{4} * nodes[PLIANT_TILE];
  const Scalar* u2 = node_u + std::int64_t{4} * nodes[2 * PLIANT_TILE];
  const Scalar* u3 = node_u + std::int64_t{4} * nodes[3 * PLIANT_TILE];
  const Scalar x1 = u1[0] - u0[0], y1 = u1[1] - u0[1], z1 = u1[2] - u0[2];
  const Scalar x2 = u2[0] - u0[0], y2 = u2[1] - u0[1], z2 = u2[2] - u0[2];
  const Scalar x3 = u3[0] - u0[0], y3 = u3[1] - u0[1], z3 = u3[2] - u0[2];
  const Scalar* data = tet_data + tile_base(e, PLIANT_TET_DATA_PLANES);
  Tet4<Scalar> t;
  t.b1x = data[0], t.b1y = data[PLIANT_TILE], t.b1z = data[2 * PLIANT_TILE];
  t.b2x = data[3 * PLIANT_TILE], t.b2y = data[4 * PLIANT_TILE], t.b2z = data[5 * PLIANT_TILE];
  t.b3x = data[6 * PLIANT_TILE], t.b3y = data[7 * PLIANT_TILE], t.b3z = data[8 * PLIANT_TILE];
  t.volume = data[9 * PLIANT_TILE];
  t.h = {dot3(x1, t.b1x, x2, t.b2x, x3, t.b3x), dot3(x1, t.b1y, x2, t.b2y, x3, t.b3y), dot3(x1, t.b1z, x2, t.b2z, x3, t.b3z),
         dot3(y1, t.b1x, y2, t.b2x, y3, t.b3x), dot3(y1, t.b1y, y2, t.b2y, y3, t.b3y), dot3(y1, t.b1z, y2, t.b2z, y3, t.b3z),
         dot3(z1, t.b1x, z2, t.b2x, z3, t.b3x), dot3(z1, t.b1y, z2, t.b2y, z3, t.b3y), dot3(z1, t.b1z, z2, t.b2z, z3, t.b3z)};
  return t;
}

}  // namespace pliant::ref
