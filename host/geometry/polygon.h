// Triangulation of polygons with holes that never fails: however rounded the coordinates are, every side of the polygon is used
// once, in its direction, and all other sides come in opposite pairs.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pliant::overlay {

/// A corner of a polygon in its plane. Corners with a common bit in `lines` lie on one straight line: no inner side joins them,
/// since whatever lies beyond that line may have the same side.
struct FlatPoint {
  double x = 0, y = 0;
  std::uint8_t lines = 0;
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
