// Triangles projected along an axis, in bins across it: the columns of space above or below a surface.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec3.h"

namespace pliant::columns {

/// A triangle in the coordinates (x, y, z) with z along the axis, its corners counter-clockwise in x and y.
struct Column {
  std::array<Vec3d, 3> corner{};
  double sign = 0;     ///< 1 if the triangle, as it was, faces up, -1 if down
  double stretch = 0;  ///< area over projected area, where this axis is to measure the triangle's area; otherwise 0
  double area2 = 0;    ///< twice the projected area [m^2], positive
  Vec3d lower{}, upper{};
};

/// Returns a column; its area2 is 0 if the triangle is seen edge-on. `axis`: 0, 1, 2 for x, y, z of the corners, which are
/// relative to `centre`.
Column column_of(const std::array<Vec3d, 3>& corners, std::size_t axis, const Vec3d& centre);

/// Height of a triangle's plane at a place in the triangle [m], never beyond its corners.
double height_at(const Column& c, double x, double y);

/// Where z of the first triangle lies below that of the second one, over the intersection of their projections.
struct Between {
  double area = 0;    ///< projected area [m^2]; where the two lie in each other, half of it
  double volume = 0;  ///< of the space between them [m^3]
  Vec3d moment{};     ///< integral of (x, y, z) over it [m^4]
};
/// `tie`: heights that differ by at most this everywhere are equal [m].
Between between(const Column& below, const Column& above, double tie);

/// 1 if the place lies in the triangle's projection, otherwise 0. Of triangles that share an edge it lies in one.
int covers(const Column& c, double x, double y);

/// Bins over a rectangle of x and y, about as many as there are columns and as wide as they are.
class Bins {
 public:
  Bins(const std::vector<Column>& columns, const Vec3d& lower, const Vec3d& upper);

  /// Calls visit(index) once for each column whose box overlaps that of x and y, within the rectangle.
  template <class Visit>
  void overlapping(const Vec3d& lower, const Vec3d& upper, const Visit& visit) const {
    const std::array<std::int64_t, 2> from = bin_of(lower), to = bin_of(upper);
    for (std::int64_t row = from[1]; row <= to[1]; ++row) {
      for (std::int64_t bin = row * count_[0] + from[0]; bin <= row * count_[0] + to[0]; ++bin) {
        for (std::size_t k = first_[static_cast<std::size_t>(bin)]; k < first_[static_cast<std::size_t>(bin) + 1]; ++k) {
          const Column& c = (*columns_)[entries_[k]];
          if (c.upper[0] < lower[0] || c.lower[0] > upper[0] || c.upper[1] < lower[1] || c.lower[1] > upper[1]) continue;
          // A pair stands in several bins and counts in that of the lower corner of the intersection of both boxes.
          const auto own = bin_of({std::max(c.lower[0], lower[0]), std::max(c.lower[1], lower[1]), 0});
          if (own[1] * count_[0] + own[0] == bin) visit(entries_[k]);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::array<std::int64_t, 2> bin_of(const Vec3d& p) const;

  const std::vector<Column>* columns_;
  std::array<double, 2> lower_{}, width_{};
  std::array<std::int64_t, 2> count_{1, 1};
  std::vector<std::size_t> first_, entries_;
};

}  // namespace pliant::columns
