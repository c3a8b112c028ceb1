// Exact tests of segments and tetrahedra against the triangles of a sweep, and the nearest point on it.
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
  /// All query points must be in `box` [m]; `edge` [m] is the typical size of queries. Throws Error for non-finite triangles.
  SweepProbe(vec::Box box, double edge, std::span<const SweepTriangle> sweep);

  /// A point with its number, 0 .. 2^61 - 1, the same for the same point.
  [[nodiscard]] ExactPoint point(const Vec3d& x, std::int64_t number) const { return frame_.snap(x, number); }
  /// Returns whether a triangle separates two points; `at` (may be null) receives the fraction of the way to the first one.
  bool between(const ExactPoint& a, const Vec3d& xa, const ExactPoint& b, const Vec3d& xb, double* at = nullptr);
  /// Returns whether a triangle touches a tetrahedron.
  bool touches(const std::array<ExactPoint, 4>& tet, const std::array<Vec3d, 4>& x);
  /// Finds the point of the sweep nearest to x within `reach` [m]; returns false if there is none.
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
