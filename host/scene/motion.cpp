#include "scene/motion.h"

#include <cmath>

#include "geometry/vec.h"

namespace pliant {

Circle circle_of(const Rotation& rotation, const Vec3d& x) {
  const Vec3d n = vec::mul(rotation.axis, 1 / vec::norm(rotation.axis)), r = vec::sub(x, rotation.about);
  return {vec::sub(r, vec::mul(n, vec::dot(n, r))), vec::cross(n, r)};
}

Vec3d AffineField::at(const Vec3d& x) const {
  const Vec3d r = vec::sub(x, about);
  Vec3d out = offset;
  for (std::size_t c = 0; c < 3; ++c) out[c] += vec::dot(linear[c], r);
  return out;
}

}  // namespace pliant
