// What a sweep touches: exact tests of segments and tetrahedra against its triangles, and the nearest point on it.
#pragma once
#include <array>
#include <map>
#include <span>
#include <vector>

#include "cutting/blade/blade.h"
#include "geometry/predicates.h"
#include "geometry/spatial_hash.h"

namespace pliant {

class SweepProbe {
 public:
  /// All points asked about lie in `box` [m]; `edge` [m] is about the size of what is asked about. Throws Error for triangles
  /// that are not finite.
  SweepProbe(vec::Box box, double edge, std::span<const SweepTriangle> sweep);

  /// A point with its number, 0 .. 2^61 - 1, the same for the same point.
  [[nodiscard]] ExactPoint point(const Vec3d& x, std::int64_t number) const { return frame_.snap(x, number); }
  /// Whether a triangle lies between two points; `at`, if given, takes the share of the way to the first of them.
  bool between(const ExactPoint& a, const Vec3d& xa, const ExactPoint& b, const Vec3d& xb, double* at = nullptr);
  /// Whether a triangle touches a tetrahedron.
  bool touches(const std::array<ExactPoint, 4>& tet, const std::array<Vec3d, 4>& x);
  /// The point of the sweep that is nearest to x, looked for within `reach` [m]; false if there is none.
  bool nearest(const Vec3d& x, double reach, Vec3d& out);
  [[nodiscard]] bool empty() const { return corner_.empty(); }

 private:
  std::vector<std::int32_t> hits(const vec::Box& box);
  ExactFrame frame_;
  SpatialHash hash_;
  std::vector<SweepTriangle> sweep_;
  std::vector<std::array<ExactPoint, 3>> corner_;
};

}  // namespace pliant
