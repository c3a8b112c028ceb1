#include "simulation/contact/sunken_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/triangle_tree.h"
#include "geometry/vec.h"
#include "simulation/contact/tool_samples.h"

namespace pliant {
namespace {

constexpr std::size_t kSamples = 12;  ///< points of a tool

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

}  // namespace

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
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    for (std::int32_t v = body.first_vertex; v < body.first_vertex + body.vertices; ++v)
      boxes_[b].extend(vertices_[static_cast<std::size_t>(v)]);
  }
}

template <class Visit>
void BodySurfaces::triangles(const ModelBody& body, Visit&& visit) const {
  for (std::int32_t i = body.first_triangle; i < body.first_triangle + body.triangles; ++i) {
    const auto& t = model_.surface.triangles[static_cast<std::size_t>(i)];
    visit(Corners{vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
  }
}

bool BodySurfaces::is_inside(const ModelBody& body, const Vec3d& x) const {
  bool below = false;
  triangles(body, [&](const Corners& t) { below = below || is_below(t, x); });
  if (!below) return false;
  double angle = 0;
  triangles(body, [&](const Corners& t) { angle += solid_angle(t, x); });
  return std::abs(angle) > 2 * std::numbers::pi;
}

double BodySurfaces::distance(const ModelBody& body, const Vec3d& x) const {
  double least = HUGE_VAL;
  triangles(body, [&](const Corners& t) {
    const Vec3d apart = vec::sub(closest_on_triangle(x, t[0], t[1], t[2]), x);
    least = std::min(least, vec::dot(apart, apart));
  });
  return std::sqrt(least);
}

SunkenTool BodySurfaces::deepest(const ToolForm& form, const Pose& pose, double time) const {
  SunkenTool most;
  const ToolMoment moment = tool_moment(form, time);
  const Pose at = compose(pose, moment.pose);
  const bool round = form.shape == ToolShape::sphere || form.shape == ToolShape::capsule;
  for (const Vec3d& y : tool_samples(form, moment, kSamples)) {
    const Vec3d x = place(at, y);
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      const ModelBody& body = model_.bodies[b];
      if (boxes_[b].distance2(x) > 0 || !is_inside(body, x)) continue;
      const double depth = distance(body, x) + (round ? form.radius : 0);
      if (depth > most.depth) most = {depth, time, x, static_cast<std::int32_t>(b)};
    }
  }
  return most;
}

}  // namespace pliant
