// Where a body is, and how far from a selection that holds nothing of it: the second half of the messages that refuse one.
#pragma once
#include <limits>
#include <span>
#include <string>

#include "geometry/vec.h"
#include "scene/selection.h"

namespace pliant {

vec::Box bounds_of(std::span<const Vec3d> points);

/// Such as "[-0.05, -0.05, -0.05] and [0.05, 0.05, 0.05] m".
std::string corners_text(const vec::Box& box);

/// The nearest of some points to a selection that holds none of them.
class NearestPoint {
 public:
  explicit NearestPoint(const Selection& where) : where_(where) {}
  void add(const Vec3d& point);
  /// Such as "; the nearest node is at [0.1, 0, 0] m, 0.02 m away". Empty where the selection has no distances (indices,
  /// regions of a mesh), or no point was added.
  [[nodiscard]] std::string text(const char* what) const;

 private:
  const Selection& where_;
  double distance_ = std::numeric_limits<double>::infinity();
  Vec3d at_{};
};

/// The same of many points.
std::string nearest_text(const Selection& where, std::span<const Vec3d> points, const char* what);

}  // namespace pliant
