#include "geometry/columns.h"

#include <cmath>

namespace pliant::columns {
namespace {

/// A triangle whose projection is that much thinner than it is long is seen edge-on: what it covers is no more than rounding.
constexpr double kThin = 1e-15;

/// A corner of a polygon: its place, height on the lower triangle, and what the upper one lies above it [m].
struct Corner {
  double x = 0, y = 0, z = 0, above = 0;
};

/// Convex but for rounding. Each of four cuts at most doubles the number of corners, whatever rounding does.
struct Polygon {
  std::array<Corner, 48> corner;
  std::size_t count = 0;
};

/// Keeps the part where side >= 0 (Sutherland and Hodgman 1974).
template <class Side>
void cut(Polygon& p, const Side& side) {
  Polygon kept;
  for (std::size_t i = 0; i < p.count; ++i) {
    const Corner &a = p.corner[i], &b = p.corner[(i + 1) % p.count];
    const double sa = side(a), sb = side(b);
    if (sa >= 0) kept.corner[kept.count++] = a;
    if ((sa >= 0) == (sb >= 0)) continue;
    const double t = sa / (sa - sb);
    kept.corner[kept.count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z),
                                 a.above + t * (b.above - a.above)};
  }
  p.count = kept.count;
  std::copy(kept.corner.begin(), kept.corner.begin() + static_cast<std::ptrdiff_t>(kept.count), p.corner.begin());
}

double turn(const Corner& a, const Corner& b, const Corner& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The rule of the three midpoints of the edges is exact for the squares that the moments are made of.
void add_triangle(const Corner& a, const Corner& b, const Corner& c, Between& sum) {
  const double area = 0.5 * turn(a, b, c);
  sum.area += area;
  const std::array<std::array<const Corner*, 2>, 3> edges{{{&a, &b}, {&b, &c}, {&c, &a}}};
  for (const auto& [p, q] : edges) {
    const double above = 0.5 * (p->above + q->above), volume = area / 3 * above;
    sum.volume += volume;
    sum.moment[0] += volume * 0.5 * (p->x + q->x);
    sum.moment[1] += volume * 0.5 * (p->y + q->y);
    sum.moment[2] += volume * 0.5 * (p->z + q->z + above);
  }
}

/// What an edge counts for a ray from the place towards larger x. The order of its ends does not matter, so that the two
/// triangles at an edge agree.
int crossed(const Vec3d& a, const Vec3d& b, double x, double y) {
  if ((a[1] <= y) == (b[1] <= y)) return 0;
  const bool up = b[1] > a[1];
  const Vec3d &low = up ? a : b, &high = up ? b : a;
  const double left = (high[0] - low[0]) * (y - low[1]) - (x - low[0]) * (high[1] - low[1]);
  if (!(left > 0)) return 0;
  return up ? 1 : -1;
}

}  // namespace

Column column_of(const std::array<Vec3d, 3>& corners, std::size_t axis, const Vec3d& centre) {
  Column c;
  const std::array<std::size_t, 3> from{(axis + 1) % 3, (axis + 2) % 3, axis};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) c.corner[k][a] = corners[k][from[a]] - centre[from[a]];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    c.lower[a] = std::min({c.corner[0][a], c.corner[1][a], c.corner[2][a]});
    c.upper[a] = std::max({c.corner[0][a], c.corner[1][a], c.corner[2][a]});
  }
  const Vec3d &p = c.corner[0], &q = c.corner[1], &r = c.corner[2];
  const double area2 = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  const double longest = std::max(c.upper[0] - c.lower[0], c.upper[1] - c.lower[1]);
  if (!(std::abs(area2) > kThin * longest * longest)) return c;
  c.sign = area2 > 0 ? 1 : -1;
  c.area2 = std::abs(area2);
  if (area2 < 0) std::swap(c.corner[1], c.corner[2]);
  return c;
}

double height_at(const Column& c, double x, double y) {
  const Vec3d &p = c.corner[0], &q = c.corner[1], &r = c.corner[2];
  const double of_q = (x - p[0]) * (r[1] - p[1]) - (y - p[1]) * (r[0] - p[0]);
  const double of_r = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
  const double z = p[2] + (of_q * (q[2] - p[2]) + of_r * (r[2] - p[2])) / c.area2;
  return std::clamp(z, c.lower[2], c.upper[2]);
}

Between between(const Column& below, const Column& above, double tie) {
  Polygon p;
  p.count = 3;
  for (std::size_t k = 0; k < 3; ++k) p.corner[k] = {below.corner[k][0], below.corner[k][1], below.corner[k][2], 0};
  for (std::size_t k = 0; k < 3 && p.count > 0; ++k) {
    const Vec3d &a = above.corner[k], &b = above.corner[(k + 1) % 3];
    cut(p, [&](const Corner& c) { return (b[0] - a[0]) * (c.y - a[1]) - (b[1] - a[1]) * (c.x - a[0]); });
  }
  Between sum;
  bool equal = true;
  for (std::size_t k = 0; k < p.count; ++k) {
    Corner& c = p.corner[k];
    c.above = height_at(above, c.x, c.y) - c.z;
    equal = equal && std::abs(c.above) <= tie;
  }
  if (!equal) cut(p, [](const Corner& c) { return c.above; });
  for (std::size_t k = 2; k < p.count; ++k) add_triangle(p.corner[0], p.corner[k - 1], p.corner[k], sum);
  if (equal) return {0.5 * sum.area, 0, {}};
  return sum;
}

int covers(const Column& c, double x, double y) {
  return crossed(c.corner[0], c.corner[1], x, y) + crossed(c.corner[1], c.corner[2], x, y) +
         crossed(c.corner[2], c.corner[0], x, y);
}

Bins::Bins(const std::vector<Column>& columns, const Vec3d& lower, const Vec3d& upper) : columns_(&columns) {
  const double most = 2.0 * static_cast<double>(columns.size()) + 1;
  std::array<double, 2> size{}, mean{};
  for (std::size_t a = 0; a < 2; ++a) {
    lower_[a] = lower[a];
    size[a] = upper[a] - lower[a];
    for (const Column& c : columns) {
      mean[a] += std::max(0.0, std::min(c.upper[a], upper[a]) - std::max(c.lower[a], lower[a]));
    }
    mean[a] /= std::max(1.0, static_cast<double>(columns.size()));
  }
  std::array<double, 2> wanted{};
  for (std::size_t a = 0; a < 2; ++a) wanted[a] = mean[a] > 0 ? std::clamp(size[a] / mean[a], 1.0, most) : 1;
  const double shrink = std::sqrt(std::min(1.0, most / (wanted[0] * wanted[1])));
  for (std::size_t a = 0; a < 2; ++a) {
    count_[a] = std::max<std::int64_t>(1, static_cast<std::int64_t>(wanted[a] * shrink));
    width_[a] = size[a] / static_cast<double>(count_[a]);
  }
  first_.assign(static_cast<std::size_t>(count_[0] * count_[1]) + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto from = bin_of(columns[i].lower), to = bin_of(columns[i].upper);
      for (std::int64_t row = from[1]; row <= to[1]; ++row) {
        for (std::int64_t bin = from[0]; bin <= to[0]; ++bin) visit(static_cast<std::size_t>(row * count_[0] + bin), i);
      }
    }
  };
  each([&](std::size_t bin, std::size_t) { ++first_[bin + 1]; });
  for (std::size_t bin = 1; bin < first_.size(); ++bin) first_[bin] += first_[bin - 1];
  entries_.resize(first_.back());
  std::vector<std::size_t> next = first_;
  each([&](std::size_t bin, std::size_t i) { entries_[next[bin]++] = i; });
}

std::array<std::int64_t, 2> Bins::bin_of(const Vec3d& p) const {
  std::array<std::int64_t, 2> bin{};
  for (std::size_t a = 0; a < 2; ++a) {
    const double at = width_[a] > 0 ? (p[a] - lower_[a]) / width_[a] : 0;
    bin[a] = static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(count_[a] - 1)));
  }
  return bin;
}

}  // namespace pliant::columns
