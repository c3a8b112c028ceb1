#include "simulation/contact/sunken_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/triangle_tree.h"
#include "geometry/vec.h"
#include "simulation/contact/tool_samples.h"

namespace pliant {
namespace {

constexpr std::size_t kSamples = 256;  ///< most points of a mesh
constexpr std::size_t kMeasured = 16;  ///< of those that may be inside
constexpr std::size_t kConfirmed = 3;
constexpr double kWound = 0.9;  ///< least winding number inside: a body that is open is not looked at where it is open
constexpr double kWoundByPoints = 0.5;
/// A surface whose triangles are larger, in cells, does not show the dents of its cells; its points of contact do.
constexpr double kCoarse = 1.2;

using Corners = std::array<Vec3d, 3>;

/// Solid angle of a triangle (van Oosterom and Strackee 1983, eq. 8).
double solid_angle(const Corners& t, const Vec3d& x) {
  const Vec3d a = vec::sub(t[0], x), b = vec::sub(t[1], x), c = vec::sub(t[2], x);
  const double la = vec::norm(a), lb = vec::norm(b), lc = vec::norm(c);
  const double below = la * lb * lc + vec::dot(a, b) * lc + vec::dot(b, c) * la + vec::dot(c, a) * lb;
  return 2 * std::atan2(vec::dot(a, vec::cross(b, c)), below);
}

/// Whether the line through x along z meets a triangle, or its edge, above x.
bool is_below(const Corners& t, const Vec3d& x) {
  if (x[2] > std::max({t[0][2], t[1][2], t[2][2]})) return false;
  double weighed = 0, whole = 0;
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d &a = t[k], &b = t[(k + 1) % 3];
    const double side = (a[0] - x[0]) * (b[1] - x[1]) - (b[0] - x[0]) * (a[1] - x[1]);
    left = left || side > 0;
    right = right || side < 0;
    weighed += side * t[(k + 2) % 3][2];
    whole += side;
  }
  return left != right && weighed / whole > x[2];
}

/// The size of its cells, or twice the distance between its points of contact [m].
double cell_of(const Model& model, std::size_t body) {
  if (model.bodies[body].spacing > 0) return model.bodies[body].spacing;
  const ContactPoints& points = *model.contact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.body[i] == static_cast<std::int32_t>(body)) return 2 * points.apart[i];
  }
  return points.spacing;
}

/// A box around another one, in a frame.
vec::Box seen_from(const Pose& frame, const vec::Box& box) {
  vec::Box out;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = (corner >> c & 1) != 0 ? box.upper[c] : box.lower[c];
    out.extend(place_back(frame, x));
  }
  return out;
}

/// Not of a body without a surface, or whose nodes are lost.
bool is_finite(const vec::Box& box) {
  const double size = vec::norm(vec::sub(box.upper, box.lower));
  return box.lower[0] <= box.upper[0] && std::isfinite(size) && std::isfinite(vec::norm(box.lower));
}

}  // namespace

template <class Visit>
void BodySurfaces::triangles(const ModelBody& body, Visit&& visit) const {
  for (std::int32_t i = body.first_triangle; i < body.first_triangle + body.triangles; ++i) {
    const auto& t = model_.surface.triangles[static_cast<std::size_t>(i)];
    visit(Corners{vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
  }
}

BodySurfaces::BodySurfaces(const Model& model, const std::vector<double>& u) : model_(model) {
  const ModelSurface& s = model.surface;
  vertices_ = s.rest;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    for (std::size_t a = 0; a < 8; ++a) {
      if (s.weights[v][a] == 0) continue;
      const double* moved = &u[4 * static_cast<std::size_t>(s.nodes[v][a])];
      for (std::size_t c = 0; c < 3; ++c) vertices_[v][c] += s.weights[v][a] * moved[c];
    }
  }
  boxes_.resize(model.bodies.size());
  coarse_.resize(model.bodies.size());
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    for (std::int32_t v = body.first_vertex; v < body.first_vertex + body.vertices; ++v)
      boxes_[b].extend(vertices_[static_cast<std::size_t>(v)]);
    double area = 0;
    triangles(body, [&](const Corners& t) { area += vec::norm(vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0]))) / 2; });
    if (std::sqrt(area / std::max(1, body.triangles)) > kCoarse * cell_of(model, b)) {
      add_points(b, u);
      for (const Facet& facet : coarse_[b]) boxes_[b].extend(facet.x);
    }
  }
}

void BodySurfaces::add_points(std::size_t b, const std::vector<double>& u) {
  const ContactPoints& points = *model_.contact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.body[i] != static_cast<std::int32_t>(b)) continue;
    Facet facet{points.rest[i], vec::mul(points.normal[i], points.area[i])};
    for (std::size_t a = 0; a < 8; ++a) {
      const double weight = double(points.weights[i][a]) / contact_weight_unit;
      const double* moved = &u[4 * static_cast<std::size_t>(points.nodes[i][a])];
      for (std::size_t c = 0; c < 3; ++c) facet.x[c] += weight * moved[c];
    }
    coarse_[b].push_back(facet);
  }
}

bool BodySurfaces::may_be_inside(const ModelBody& body, const Vec3d& x) const {
  if (!points_of(body).empty()) return is_inside(body, x);
  bool below = false;
  triangles(body, [&](const Corners& t) { below = below || is_below(t, x); });
  return below;
}

bool BodySurfaces::is_inside(const ModelBody& body, const Vec3d& x) const {
  if (const std::vector<Facet>& facets = points_of(body); !facets.empty()) {  // as Barill et al. (2018) for points with normals
    double angle = 0;
    for (const Facet& facet : facets) {
      const Vec3d way = vec::sub(facet.x, x);
      const double far = vec::norm(way);
      angle += far > 0 ? vec::dot(facet.area, way) / (far * far * far) : 0;
    }
    return angle > kWoundByPoints * 4 * std::numbers::pi;
  }
  double angle = 0;
  triangles(body, [&](const Corners& t) { angle += solid_angle(t, x); });
  return std::abs(angle) > kWound * 4 * std::numbers::pi;
}

double BodySurfaces::distance(const ModelBody& body, const Vec3d& x) const {
  double least = HUGE_VAL;
  for (const Facet& facet : points_of(body)) {
    const Vec3d apart = vec::sub(facet.x, x);
    least = std::min(least, vec::dot(apart, apart));
  }
  if (least < HUGE_VAL) return std::sqrt(least);
  triangles(body, [&](const Corners& t) {
    const Vec3d apart = vec::sub(closest_on_triangle(x, t[0], t[1], t[2]), x);
    least = std::min(least, vec::dot(apart, apart));
  });
  return std::sqrt(least);
}

SunkenTool BodySurfaces::deepest_in(std::size_t b, const ToolForm& form, const Pose& at, const ToolMoment& moment) const {
  const ModelBody& body = model_.bodies[b];
  const double cell = cell_of(model_, b);
  std::vector<Vec3d> below;
  const std::vector<Vec3d> samples = tool_samples_in(form, moment, seen_from(at, boxes_[b]), cell, kSamples);
  for (const Vec3d& y : samples) {
    const Vec3d x = place(at, y);
    if (boxes_[b].distance2(x) == 0 && may_be_inside(body, x)) below.push_back(x);
  }
  const std::size_t every = below.size() / kMeasured + 1;
  std::vector<std::pair<double, Vec3d>> measured;  // with the distance from the surface
  for (std::size_t i = 0; i < below.size(); i += every) measured.emplace_back(distance(body, below[i]), below[i]);
  std::stable_sort(measured.begin(), measured.end(), [](const auto& a, const auto& c) { return a.first > c.first; });
  measured.resize(std::min(measured.size(), kConfirmed));
  const bool round = form.shape == ToolShape::sphere || form.shape == ToolShape::capsule;
  for (const auto& [depth, x] : measured) {
    if (is_inside(body, x)) return {depth + (round ? form.radius : 0), cell, 0, x, static_cast<std::int32_t>(b)};
  }
  return {};
}

SunkenTool BodySurfaces::deepest(const ToolForm& form, const Pose& pose, double time) const {
  SunkenTool most;
  const ToolMoment moment = tool_moment(form, time);
  const Pose at = compose(pose, moment.pose);
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (!is_finite(boxes_[b])) continue;
    SunkenTool found = deepest_in(b, form, at, moment);
    found.time = time;
    if (found.depth > most.depth) most = found;
  }
  return most;
}

}  // namespace pliant
