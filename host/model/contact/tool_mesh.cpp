#include "model/contact/tool_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// The points at most `radius` from a segment; a sphere if both ends are one. `around`: a multiple of four, so that a row lies
/// at the equator.
TriangleMesh capsule(const Vec3d& first, const Vec3d& second, double radius, int around) {
  const int up = around / 2;
  Vec3d axis = vec::sub(second, first);
  const double length = vec::norm(axis);
  axis = length > 0 ? vec::mul(axis, 1 / length) : Vec3d{0, 0, 1};
  const Vec3d helper = std::abs(axis[0]) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d side = vec::cross(axis, helper);
  side = vec::mul(side, 1 / vec::norm(side));
  const Vec3d other = vec::cross(axis, side);
  TriangleMesh mesh;
  // Rows from pole to pole; the one at the equator stands at both ends.
  for (int row = 0; row <= up + 1; ++row) {
    const bool upper = row > up / 2;
    const double angle = std::numbers::pi * ((upper ? row - 1 : row) / static_cast<double>(up) - 0.5);
    for (int k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * k / around, across = radius * std::cos(angle);
      Vec3d x = vec::add(upper ? second : first, vec::mul(axis, radius * std::sin(angle)));
      x = vec::add(x, vec::add(vec::mul(side, across * std::cos(turn)), vec::mul(other, across * std::sin(turn))));
      mesh.vertices.push_back(x);
    }
  }
  for (int row = 0; row <= up; ++row) {
    for (int k = 0; k < around; ++k) {
      const std::int32_t a = row * around + k, b = row * around + (k + 1) % around;
      if (row > 0) mesh.triangles.push_back({a, b, b + around});
      if (row < up) mesh.triangles.push_back({a, b + around, a + around});
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

/// Half a blade, between its middle plane and its profile (kernels/contact/contact_face.cl).
TriangleMesh half_blade(const ToolForm& form) {
  const double side = form.first[0], half = form.second[0], up = form.second[1] - half / form.first[1],
               along = form.second[2] - half / form.first[2];
  TriangleMesh mesh;
  for (const auto& [x, y, z] : {Vec3d{0, form.second[1], form.second[2]}, Vec3d{side * half, up, along}}) {
    for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) mesh.vertices.push_back({x, a * y, b * z});
  }
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    if (side < 0) std::swap(b, d);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(3, 2, 1, 0);
  quad(4, 5, 6, 7);
  for (std::int32_t k = 0; k < 4; ++k) quad(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k);
  return mesh;
}

}  // namespace

TriangleMesh tool_mesh(const ToolForm& form, int around) {
  switch (form.shape) {
    case ToolShape::sphere:
      return capsule({}, {}, form.radius, around);
    case ToolShape::capsule:
      return capsule(form.first, form.second, form.radius, around);
    case ToolShape::box:
      return box(form.second);
    case ToolShape::mesh:
      return form.surface;
    case ToolShape::blade_face:
      return half_blade(form);
    case ToolShape::half_space:
    case ToolShape::sequence:
      break;
  }
  return {};
}

TriangleMesh tool_mesh_of_volume(const ToolForm& form, int around) {
  if (form.shape != ToolShape::sphere && form.shape != ToolShape::capsule) return tool_mesh(form, around);
  const bool round = form.shape == ToolShape::sphere;
  const double length = round ? 0 : vec::norm(vec::sub(form.second, form.first)), r = form.radius;
  const double volume = std::numbers::pi * r * r * (length + 4 * r / 3);
  // That of the mesh is a prism over a polygon and a ball: along r^2 + ball r^3.
  const double along = length * 0.5 * around * std::sin(2 * std::numbers::pi / around);
  const double ball = signed_volume(capsule({}, {}, 1, around));
  double wider = r;
  for (int n = 0; n < 4; ++n) {  // Newton, from very close
    wider -= (along * wider * wider + ball * wider * wider * wider - volume) / (2 * along * wider + 3 * ball * wider * wider);
  }
  return round ? capsule({}, {}, wider, around) : capsule(form.first, form.second, wider, around);
}

}  // namespace pliant
