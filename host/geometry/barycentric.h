// Barycentric coordinates in a tetrahedron.
#pragma once
#include <array>

#include "geometry/vec.h"

namespace pliant {

/// Weights of the corners `x` [m] that add up to the point `p` [m], with sum 1; some are negative outside.
inline std::array<double, 4> barycentric_weights(const std::array<Vec3d, 4>& x, const Vec3d& p) {
  const Vec3d a = vec::sub(x[1], x[0]), b = vec::sub(x[2], x[0]), c = vec::sub(x[3], x[0]), r = vec::sub(p, x[0]);
  const double volume = vec::dot(a, vec::cross(b, c));
  const double wa = vec::dot(r, vec::cross(b, c)) / volume, wb = vec::dot(a, vec::cross(r, c)) / volume,
               wc = vec::dot(a, vec::cross(b, r)) / volume;
  return {1 - wa - wb - wc, wa, wb, wc};
}

}  // namespace pliant
