// Motion that a scene gives: rotations of prescribed nodes, and fields of velocity and displacement at the start.
#pragma once
#include <array>

#include "geometry/vec3.h"
#include "scene/curve.h"
#include "scene/selection.h"

namespace pliant {

/// A rotation about an axis in space, right-handed.
struct Rotation {
  Vec3d axis{0, 0, 1};  ///< its direction, of any length but zero
  Vec3d about{};        ///< a point on it [m]
  double angle = 0;     ///< [degrees] at factor 1
};

/// The displacement of X is (cos(angle) - 1) cosine + sin(angle) sine, both [m]: the part of X - about across the axis, and
/// that turned by a right angle (Rodrigues).
struct Circle {
  Vec3d cosine{}, sine{};
};
Circle circle_of(const Rotation& rotation, const Vec3d& x);

/// An affine field of the place at rest: offset + linear (X - about).
struct AffineField {
  Vec3d offset{};
  std::array<Vec3d, 3> linear{};  ///< rows
  Vec3d about{};                  ///< [m]
  [[nodiscard]] Vec3d at(const Vec3d& x) const;
  [[nodiscard]] bool zero() const { return offset == Vec3d{} && linear == std::array<Vec3d, 3>{}; }
};

/// Motion at the start, in addition to other entries and the body's velocities at the same nodes.
struct Initial {
  Selection where;
  AffineField velocity;      ///< [m/s]
  AffineField displacement;  ///< [m]
};

}  // namespace pliant
