// Displacement gradient of a linear tetrahedron: H = sum_a (u_a - u_0) (x) grad N_a, a = 1..3. The twins process a tile of
// sixteen tetrahedra at a time: first they gather the scattered data, then a loop without branches or gathers computes all
// elements, which compilers can vectorize.
#pragma once
#include <cstdint>

#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {

template <class Scalar>
struct Tet4 {
  Mat3<Scalar> h;                                      ///< [1]
  Scalar b1x, b1y, b1z, b2x, b2y, b2z, b3x, b3y, b3z;  ///< grad N_1..3 [1/m]
  Scalar volume;                                       ///< [m^3]
};

/// Displacements of the corners of a tile's elements: [corner][component][element].
template <class Scalar>
using Tet4Corners = Scalar[4][3][PLIANT_TILE];

/// `nodes`: the tile's [4][16] node indices.
template <class Scalar>
inline void tet4_gather(const Scalar* node_u, const std::int32_t* nodes, Tet4Corners<Scalar>& u) {
  for (int a = 0; a < 4; ++a) {
    for (int e = 0; e < PLIANT_TILE; ++e) {
      const Scalar* texel = node_u + std::int64_t{4} * nodes[a * PLIANT_TILE + e];
      for (int c = 0; c < 3; ++c) u[a][c][e] = texel[c];
    }
  }
}

/// Element e of a tile; `data`: the tile's [10][16] numbers.
template <class Scalar>
[[gnu::always_inline]] inline Tet4<Scalar> tet4_load(const Tet4Corners<Scalar>& u, const Scalar* data, int e) {
  const Scalar x0 = u[0][0][e], y0 = u[0][1][e], z0 = u[0][2][e];
  const Scalar x1 = u[1][0][e] - x0, y1 = u[1][1][e] - y0, z1 = u[1][2][e] - z0;
  const Scalar x2 = u[2][0][e] - x0, y2 = u[2][1][e] - y0, z2 = u[2][2][e] - z0;
  const Scalar x3 = u[3][0][e] - x0, y3 = u[3][1][e] - y0, z3 = u[3][2][e] - z0;
  const auto plane = [&](int k) { return data[k * PLIANT_TILE + e]; };
  Tet4<Scalar> t;
  t.b1x = plane(0), t.b1y = plane(1), t.b1z = plane(2);
  t.b2x = plane(3), t.b2y = plane(4), t.b2z = plane(5);
  t.b3x = plane(6), t.b3y = plane(7), t.b3z = plane(8);
  t.volume = plane(9);
  t.h = {dot3(x1, t.b1x, x2, t.b2x, x3, t.b3x), dot3(x1, t.b1y, x2, t.b2y, x3, t.b3y), dot3(x1, t.b1z, x2, t.b2z, x3, t.b3z),
         dot3(y1, t.b1x, y2, t.b2x, y3, t.b3x), dot3(y1, t.b1y, y2, t.b2y, y3, t.b3y), dot3(y1, t.b1z, y2, t.b2z, y3, t.b3z),
         dot3(z1, t.b1x, z2, t.b2x, z3, t.b3x), dot3(z1, t.b1y, z2, t.b2y, z3, t.b3y), dot3(z1, t.b1z, z2, t.b2z, z3, t.b3z)};
  return t;
}

}  // namespace pliant::ref
