#include "cutting/blade_front.h"

#include <algorithm>
#include <cmath>

#include "model/vec.h"

namespace pliant {
namespace {

/// The same formula wherever a point of a blade is meant: the same bits.
Vec3d point_of(const BladeSegment& blade, std::int32_t place, std::int32_t places) {
  if (place == 0) return blade[0];
  if (place == places) return blade[1];
  return vec::add(blade[0], vec::mul(vec::sub(blade[1], blade[0]), static_cast<double>(place) / places));
}

/// Places whose points may lie in a box: [first, last], empty if first > last.
std::array<std::int32_t, 2> places_in(const vec::Box& box, const BladeSegment& blade, std::int32_t places) {
  double from = 0, to = 1;
  for (int a = 0; a < 3; ++a) {
    const double start = blade[0][a], along = blade[1][a] - start;
    if (along == 0) {
      if (start < box.lower[a] || start > box.upper[a]) return {1, 0};
      continue;
    }
    const double s = (box.lower[a] - start) / along, t = (box.upper[a] - start) / along;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  if (!(from <= to)) return {1, 0};
  return {static_cast<std::int32_t>(std::floor(from * places)), static_cast<std::int32_t>(std::ceil(to * places))};
}

/// Barycentric coordinates; the first is NaN or infinite in a tetrahedron without volume.
std::array<double, 4> barycentric(const std::array<Vec3d, 4>& x, const Vec3d& p) {
  const Vec3d a = vec::sub(x[1], x[0]), b = vec::sub(x[2], x[0]), c = vec::sub(x[3], x[0]), r = vec::sub(p, x[0]);
  const double scale = 1 / vec::dot(a, vec::cross(b, c));
  const double wa = scale * vec::dot(r, vec::cross(b, c)), wb = scale * vec::dot(a, vec::cross(r, c)),
               wc = scale * vec::dot(a, vec::cross(b, r));
  return {1 - wa - wb - wc, wa, wb, wc};
}

}  // namespace

int front_levels(const BladeSegment& blade, double edge) {
  const double points = 2 * vec::norm(vec::sub(blade[1], blade[0])) / edge;
  return points > 1 ? std::min(12, std::ilogb(points) + 1) : 0;
}

BladeFront hold_front(const CutTopology& body, std::span<const Vec3d> x, const BladeSegment& blade, int levels) {
  BladeFront front{blade, levels, {}};
  const std::int32_t places = 1 << levels;
  const CutElements& elements = body.elements();
  const CellShape& shape = *body.mesh().shape;
  vec::Box reach;
  reach.extend(blade[0]);
  reach.extend(blade[1]);
  std::vector<char> found(static_cast<std::size_t>(places) + 1, 0);
  for (std::size_t e = 0; e < elements.nodes.size(); ++e) {
    vec::Box box;
    for (int a = 0; a < shape.corners; ++a) box.extend(x[elements.nodes[e][a]]);
    if (!box.overlaps(reach)) continue;
    const auto [first, last] = places_in(box, blade, places);
    for (std::int32_t place = std::max(first, 0); place <= std::min(last, places); ++place) {
      if (found[place] != 0) continue;
      const Vec3d p = point_of(blade, place, places);
      for (int t = 0; t < static_cast<int>(shape.tets.size()); ++t) {
        std::array<Vec3d, 4> corner;
        for (std::size_t a = 0; a < 4; ++a) corner[a] = x[elements.nodes[e][shape.tets[t][a]]];
        const std::array<double, 4> weight = barycentric(corner, p);
        if (!(*std::min_element(weight.begin(), weight.end()) >= -1e-9)) continue;
        const std::int32_t cell = elements.cell[e];
        // A copy's virtual part holds nothing.
        if (body.element_of(cell, body.label_in(cell, t, weight)) != static_cast<std::int32_t>(e)) continue;
        front.points.push_back({place, cell, t, weight});
        found[place] = 1;
        break;
      }
    }
  }
  std::sort(front.points.begin(), front.points.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
  return front;
}

std::vector<Vec3d> front_points(const BladeFront& front) {
  const std::int32_t places = 1 << front.levels;
  std::vector<Vec3d> points;
  for (std::int32_t place = 0; place <= places; ++place) points.push_back(point_of(front.blade, place, places));
  return points;
}

std::vector<Vec3d> carried_front(const BladeFront& front, const CutTopology& body, std::span<const Vec3d> x) {
  std::vector<Vec3d> points = front_points(front);
  for (const FrontPoint& f : front.points) {
    const std::int32_t element = body.element_of(f.cell, body.label_in(f.cell, f.tet, f.weight));
    if (element < 0) continue;
    Vec3d p{};
    for (std::size_t a = 0; a < 4; ++a) {
      const int corner = body.mesh().shape->tets[f.tet][a];
      p = vec::add(p, vec::mul(x[body.elements().nodes[element][corner]], f.weight[a]));
    }
    // What has not moved keeps its bits.
    const Vec3d& before = points[f.place];
    const double size = std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
    if (vec::finite(p) && vec::norm(vec::sub(p, before)) > 1e-12 * size) points[f.place] = p;
  }
  return points;
}

std::vector<SweepTriangle> sweep_to(const std::vector<Vec3d>& from, const BladeSegment& to) {
  std::vector<SweepTriangle> triangles;
  const auto places = static_cast<std::int32_t>(from.size()) - 1;
  for (std::int32_t i = 0; i < places; ++i) {
    const Vec3d q = point_of(to, i, places), next = point_of(to, i + 1, places);
    for (const SweepTriangle& t : {SweepTriangle{from[i], from[i + 1], next}, SweepTriangle{from[i], next, q}}) {
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
    }
  }
  return triangles;
}

}  // namespace pliant
