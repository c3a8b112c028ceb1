// Triangulation of polygons with holes that never fails: however rounded the coordinates are, every side of the polygon is used
// once, in its direction, and all other sides come in opposite pairs.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace pliant::overlay {

/// A corner of a polygon in its plane. Corners with a common bit in `lines` lie on one straight line: no inner side joins them,
/// since whatever lies beyond that line may have the same side.
struct FlatPoint {
  double x = 0, y = 0;
  std::uint8_t lines = 0;
};

/// Projects a plane along the axis that its normal is closest to, keeping the sense of rotation.
class FlatAxes {
 public:
  explicit FlatAxes(const Vec3d& normal) {
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (std::abs(normal[a]) > std::abs(normal[axis])) axis = a;
    }
    u_ = (axis + 1) % 3;
    v_ = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u_, v_);
  }
  /// Returns x relative to `base`.
  [[nodiscard]] FlatPoint project(const Vec3d& x, const Vec3d& base, int lines) const {
    return {x[u_] - base[u_], x[v_] - base[v_], static_cast<std::uint8_t>(lines)};
  }

 private:
  int u_ = 0, v_ = 1;
};

/// A closed loop of corners: counter-clockwise outlines, clockwise holes (of at least two corners: a slit is a hole). A corner
/// may come several times.
struct Loop {
  std::vector<std::int32_t> corners;
  bool hole = false;
  std::int32_t group = -1;  ///< a hole does not belong to an outline of its own group, unless that is -1
};

/// Twice the signed area of a loop.
double loop_area(const std::vector<FlatPoint>& points, const std::vector<std::int32_t>& loop);

/// Triangles over `points`. A hole belongs to the smallest outline around it. Ear clipping that takes the best-shaped ear
/// first; where no ear is valid because of rounding, the least bad one.
std::vector<std::array<std::int32_t, 3>> triangulate(const std::vector<FlatPoint>& points, std::vector<Loop> loops);

}  // namespace pliant::overlay
