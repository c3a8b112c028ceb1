#include "geometry/mesh_overlap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/columns.h"
#include "geometry/triangle_tree.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

using columns::Bins;
using columns::Column;

constexpr double kTie = 1e-13;  ///< heights are equal within this fraction of the extent of what is compared

/// A triangle that is above or below the common box along some axis.
struct Near {
  std::array<Vec3d, 3> corners{};
  vec::Box box;
  std::size_t axis = 0;  ///< that nearest to its normal
  double stretch = 0;    ///< its area over that of its projection along this axis
  bool in_box = false;   ///< whether its box overlaps the common one
};

/// Columns of both meshes along an axis: those above triangles of the mesh `up`, those below of the other.
struct Columns {
  std::size_t axis = 0, up = 0;
  std::vector<Column> above, below;
};

class Overlapping {
 public:
  Overlapping(const TriangleMesh& a, const TriangleMesh& b) : mesh_{&a, &b} {}

  MeshOverlap operator()() {
    for (std::size_t m = 0; m < 2; ++m) {
      for (const auto& t : mesh_[m]->triangles) {
        for (const std::int32_t v : t) box_[m].extend(mesh_[m]->vertices[static_cast<std::size_t>(v)]);
      }
    }
    for (std::size_t a = 0; a < 3; ++a) {
      common_.lower[a] = std::max(box_[0].lower[a], box_[1].lower[a]);
      common_.upper[a] = std::min(box_[0].upper[a], box_[1].upper[a]);
      if (!(common_.lower[a] < common_.upper[a])) return {};
    }
    centre_ = vec::mul(vec::add(common_.lower, common_.upper), 0.5);
    for (std::size_t m = 0; m < 2; ++m) find_near(m);
    std::array<std::size_t, 3> up{}, cost{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      up[axis] = count(axis, 0) <= count(axis, 1) ? 0 : 1;
      cost[axis] = count(axis, up[axis]);
    }
    const auto best = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Columns c = columns_along(axis, up[axis]);
      const Bins bins(c.below, across(common_.lower, axis), across(common_.upper, axis));
      add_pairs(c, bins, axis == best);
      if (axis == best) find_deepest(c, bins);
    }
    return out_;
  }

 private:
  /// Relative to the centre, in the order of a Column.
  [[nodiscard]] Vec3d across(const Vec3d& p, std::size_t axis) const {
    const Vec3d q = vec::sub(p, centre_);
    return {q[(axis + 1) % 3], q[(axis + 2) % 3], q[axis]};
  }

  void find_near(std::size_t m) {
    for (const auto& t : mesh_[m]->triangles) {
      Near n;
      for (std::size_t k = 0; k < 3; ++k) {
        n.corners[k] = mesh_[m]->vertices[static_cast<std::size_t>(t[k])];
        n.box.extend(n.corners[k]);
      }
      int sides = 0;
      for (std::size_t a = 0; a < 3; ++a) sides += reaches(n, a) ? 1 : 0;
      if (sides < 2) continue;
      n.in_box = sides == 3;
      const Vec3d normal = vec::cross(vec::sub(n.corners[1], n.corners[0]), vec::sub(n.corners[2], n.corners[0]));
      for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(normal[a]) > std::abs(normal[n.axis])) n.axis = a;
      }
      if (normal[n.axis] != 0) n.stretch = vec::norm(normal) / std::abs(normal[n.axis]);
      for (const Vec3d& p : n.corners) {
        for (const double x : vec::sub(p, centre_)) extent_ = std::max(extent_, std::abs(x));
      }
      near_[m].push_back(n);
    }
  }

  [[nodiscard]] bool reaches(const Near& n, std::size_t a) const {
    return n.box.lower[a] <= common_.upper[a] && n.box.upper[a] >= common_.lower[a];
  }
  /// Whether the columns above (or below) a triangle can hold something of the common box.
  [[nodiscard]] bool counts(const Near& n, std::size_t axis, bool above) const {
    if (!reaches(n, (axis + 1) % 3) || !reaches(n, (axis + 2) % 3)) return false;
    return above ? n.box.lower[axis] <= common_.upper[axis] : n.box.upper[axis] >= common_.lower[axis];
  }
  [[nodiscard]] std::size_t count(std::size_t axis, std::size_t up) const {
    std::size_t sum = 0;
    for (std::size_t m = 0; m < 2; ++m) {
      for (const Near& n : near_[m]) sum += counts(n, axis, m == up) ? 1 : 0;
    }
    return sum;
  }

  [[nodiscard]] Columns columns_along(std::size_t axis, std::size_t up) const {
    Columns out{axis, up, {}, {}};
    for (std::size_t m = 0; m < 2; ++m) {
      for (const Near& n : near_[m]) {
        if (!counts(n, axis, m == up)) continue;
        Column c = columns::column_of(n.corners, axis, centre_);
        if (c.area2 == 0) continue;
        if (n.axis == axis && n.in_box) c.stretch = n.stretch;
        (m == up ? out.above : out.below).push_back(c);
      }
    }
    return out;
  }

  /// The inside of the mesh `up` is minus the sum of sign times column above, that of the other the sum of sign times column
  /// below.
  void add_pairs(const Columns& c, const Bins& below, bool volume) {
    Vec3d moment{};
    for (const Column& low : c.above) {
      below.overlapping(low.lower, low.upper, [&](std::size_t index) {
        const Column& high = c.below[index];
        if (low.lower[2] >= high.upper[2] + kTie * extent_) return;
        if (!volume && low.stretch == 0 && high.stretch == 0) return;
        ++out_.compared;
        const columns::Between between = columns::between(low, high, kTie * extent_);
        out_.area[c.up] += high.sign * low.stretch * between.area;
        out_.area[1 - c.up] -= low.sign * high.stretch * between.area;
        if (!volume) return;
        out_.volume -= low.sign * high.sign * between.volume;
        moment = vec::add(moment, vec::mul(between.moment, -low.sign * high.sign));
      });
    }
    if (!volume || !(out_.volume > 0)) return;
    const std::array<std::size_t, 3> to{(c.axis + 1) % 3, (c.axis + 2) % 3, c.axis};
    for (std::size_t a = 0; a < 3; ++a) out_.centroid[to[a]] = centre_[to[a]] + moment[a] / out_.volume;
  }

  void find_deepest(const Columns& c, const Bins& below) {
    const Bins above(c.above, across(common_.lower, c.axis), across(common_.upper, c.axis));
    for (std::size_t m = 0; m < 2; ++m) {
      const std::size_t other = 1 - m;
      const std::vector<Column>& columns = other == c.up ? c.above : c.below;
      const Bins& bins = other == c.up ? above : below;
      std::vector<Vec3d> inside;
      for (const Vec3d& v : vertices_in_box(m)) {
        const Vec3d p = across(v, c.axis);
        double winding = 0;
        bins.overlapping(p, p, [&](std::size_t index) {
          const Column& column = columns[index];
          if (columns::covers(column, p[0], p[1]) == 0) return;
          const double above_p = columns::height_at(column, p[0], p[1]) - p[2];
          if (other == c.up && above_p < 0) winding -= column.sign;
          if (other != c.up && above_p > 0) winding += column.sign;
        });
        if (winding > 0.5) inside.push_back(v);
      }
      if (!inside.empty()) take_deepest(inside, other);
    }
  }

  [[nodiscard]] std::vector<Vec3d> vertices_in_box(std::size_t m) const {
    std::vector<char> used(mesh_[m]->vertices.size(), 0);
    std::vector<Vec3d> out;
    for (const auto& t : mesh_[m]->triangles) {
      for (const std::int32_t v : t) {
        const auto i = static_cast<std::size_t>(v);
        if (used[i] != 0) continue;
        used[i] = 1;
        if (common_.distance2(mesh_[m]->vertices[i]) == 0) out.push_back(mesh_[m]->vertices[i]);
      }
    }
    return out;
  }

  /// The surface nearest to a point inside is no further than the sides of the mesh's box.
  void take_deepest(const std::vector<Vec3d>& inside, std::size_t m) {
    double furthest = HUGE_VAL;
    for (std::size_t a = 0; a < 3; ++a) {
      const double middle = std::clamp(0.5 * (box_[m].lower[a] + box_[m].upper[a]), common_.lower[a], common_.upper[a]);
      furthest = std::min({furthest, std::max(middle - box_[m].lower[a], 0.0) + kTie * extent_,
                           std::max(box_[m].upper[a] - middle, 0.0) + kTie * extent_});
    }
    TriangleMesh near{mesh_[m]->vertices, {}};
    for (const auto& t : mesh_[m]->triangles) {
      vec::Box box;
      for (const std::int32_t v : t) box.extend(mesh_[m]->vertices[static_cast<std::size_t>(v)]);
      bool reaches = true;
      for (std::size_t a = 0; a < 3; ++a) {
        reaches = reaches && box.lower[a] <= common_.upper[a] + furthest && box.upper[a] >= common_.lower[a] - furthest;
      }
      if (reaches) near.triangles.push_back(t);
    }
    const TriangleTree tree(near);
    for (const Vec3d& p : inside) {
      const double depth = tree.closest(p).distance;
      if (depth > out_.depth) out_.depth = depth, out_.deepest = p;
    }
  }

  std::array<const TriangleMesh*, 2> mesh_;
  std::array<vec::Box, 2> box_;
  vec::Box common_;
  Vec3d centre_{};
  std::array<std::vector<Near>, 2> near_;
  double extent_ = 0;  ///< largest coordinate of what is near, relative to the centre [m]
  MeshOverlap out_;
};

}  // namespace

MeshOverlap mesh_overlap(const TriangleMesh& a, const TriangleMesh& b) { return Overlapping(a, b)(); }

}  // namespace pliant
