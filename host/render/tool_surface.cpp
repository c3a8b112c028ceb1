#include "render/tool_surface.h"

#include <cmath>
#include <numbers>

#include "geometry/vec.h"

namespace pliant::render {
namespace {

constexpr int kAround = 64, kUp = 32;  ///< even, so that a row lies at the equator

/// The points at most `radius` from a segment; a sphere if both ends are one.
TriangleMesh capsule(const Vec3d& first, const Vec3d& second, double radius) {
  Vec3d axis = vec::sub(second, first);
  const double length = vec::norm(axis);
  axis = length > 0 ? vec::mul(axis, 1 / length) : Vec3d{0, 0, 1};
  const Vec3d helper = std::abs(axis[0]) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d side = vec::cross(axis, helper);
  side = vec::mul(side, 1 / vec::norm(side));
  const Vec3d other = vec::cross(axis, side);
  TriangleMesh mesh;
  // Rows from pole to pole; the one at the equator stands at both ends.
  for (int row = 0; row <= kUp + 1; ++row) {
    const bool upper = row > kUp / 2;
    const double angle = std::numbers::pi * ((upper ? row - 1 : row) / static_cast<double>(kUp) - 0.5);
    for (int k = 0; k < kAround; ++k) {
      const double turn = 2 * std::numbers::pi * k / kAround, across = radius * std::cos(angle);
      Vec3d x = vec::add(upper ? second : first, vec::mul(axis, radius * std::sin(angle)));
      x = vec::add(x, vec::add(vec::mul(side, across * std::cos(turn)), vec::mul(other, across * std::sin(turn))));
      mesh.vertices.push_back(x);
    }
  }
  for (int row = 0; row <= kUp; ++row) {
    for (int k = 0; k < kAround; ++k) {
      const std::int32_t a = row * kAround + k, b = row * kAround + (k + 1) % kAround;
      if (row > 0) mesh.triangles.push_back({a, b, b + kAround});
      if (row < kUp) mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  return mesh;
}

TriangleMesh box(const Vec3d& half) {
  TriangleMesh mesh;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Vec3d x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = (corner >> c & 1) != 0 ? half[c] : -half[c];
    mesh.vertices.push_back(x);
  }
  static constexpr std::int32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

}  // namespace

TriangleMesh tool_surface(const ToolForm& form) {
  switch (form.shape) {
    case ToolShape::sphere:
      return capsule({}, {}, form.radius);
    case ToolShape::capsule:
      return capsule(form.first, form.second, form.radius);
    case ToolShape::box:
      return box(form.second);
    case ToolShape::mesh:
      return form.surface;
    case ToolShape::half_space:
    case ToolShape::sequence:
      break;
  }
  return {};
}

void ToolSurfaces::append(const Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles) {
  const Model& model = simulation.model();
  if (model.tools == nullptr) return;
  if (made_of_ != model.tools) shapes_.clear();
  made_of_ = model.tools;
  for (std::size_t t = shapes_.size(); t < model.tools->size(); ++t) shapes_.push_back(tool_surface((*model.tools)[t]));
  for (std::size_t t = 0; t < shapes_.size(); ++t) {
    const ToolForm& form = (*model.tools)[t];
    const ToolMoment moment = tool_moment(form, simulation.time());
    const Pose pose = compose(simulation.contact().pose(t, simulation.time()), moment.pose);
    const TriangleMesh& shape =
        form.frames.empty() ? shapes_[t]
                            : form.frames[static_cast<std::size_t>(moment.frame + (moment.share < 0.5 ? 0 : 1))].surface;
    const auto first = static_cast<std::int32_t>(positions.size() / 3);
    for (const Vec3d& y : shape.vertices) {
      for (const double x : place(pose, y)) positions.push_back(static_cast<float>(x));
    }
    for (const auto& corners : shape.triangles) {
      for (const std::int32_t v : corners) triangles.push_back(first + v);
    }
  }
}

}  // namespace pliant::render
