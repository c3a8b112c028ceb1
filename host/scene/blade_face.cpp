#include "scene/blade_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant {
namespace {

constexpr double kRise = 1.0 / 3;   ///< of the height: from the edge and from the back to full thickness
constexpr double kEnds = 1.0 / 4;   ///< of the length, at most: the same from the ends
constexpr double kAcross = 1e-9;    ///< a motion or direction whose part across the edge is less of it is along the edge
constexpr double kOpposite = 1e-9;  ///< 1 + cosine below which an edge points the other way

Vec3d unit(const Vec3d& v) { return vec::mul(v, 1 / vec::norm(v)); }
Vec3d end_of(const std::array<double, 7>& row, std::size_t end) {
  return {row[3 * end + 1], row[3 * end + 2], row[3 * end + 3]};
}
Vec3d along(const std::array<Vec3d, 2>& at) { return unit(vec::sub(at[1], at[0])); }

/// Its part across a unit vector, of unit length; 0 where there is none.
Vec3d across(const Vec3d& v, const Vec3d& edge) {
  const Vec3d part = vec::sub(v, vec::mul(edge, vec::dot(v, edge)));
  return vec::norm(part) > kAcross * vec::norm(v) ? unit(part) : Vec3d{};
}

/// The shortest turn that takes one unit vector to another, applied to one that is across the first (Rodrigues).
Vec3d turned(const Vec3d& v, const Vec3d& from, const Vec3d& to) {
  const double cosine = vec::dot(from, to);
  if (1 + cosine < kOpposite) return v;  // half a turn about v
  const Vec3d axis = vec::cross(from, to), once = vec::cross(axis, v);
  return vec::add(v, vec::add(once, vec::mul(vec::cross(axis, once), 1 / (1 + cosine))));
}

/// The rotation whose columns are x, y, z (Shepperd 1978).
std::array<double, 4> turn_of(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const double trace = x[0] + y[1] + z[2];
  std::array<double, 4> q{};
  if (trace >= std::max({x[0], y[1], z[2]})) {
    q = {y[2] - z[1], z[0] - x[2], x[1] - y[0], 1 + trace};
  } else if (x[0] >= y[1] && x[0] >= z[2]) {
    q = {1 + x[0] - y[1] - z[2], x[1] + y[0], z[0] + x[2], y[2] - z[1]};
  } else if (y[1] >= z[2]) {
    q = {x[1] + y[0], 1 + y[1] - z[2] - x[0], y[2] + z[1], z[0] - x[2]};
  } else {
    q = {z[0] + x[2], y[2] + z[1], 1 + z[2] - x[0] - y[1], x[1] - y[0]};
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& c : q) c /= length;
  return q;
}

}  // namespace

double Blade::length() const {
  double longest = 0;
  for (const auto& row : path) longest = std::max(longest, vec::norm(vec::sub(end_of(row, 1), end_of(row, 0))));
  return longest;
}

Vec3d Blade::back_at_first() const {
  if (back) return across(*back, along({end_of(path[0], 0), end_of(path[0], 1)}));
  const Vec3d first = along({end_of(path[0], 0), end_of(path[0], 1)});
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3d here = along({end_of(path[i - 1], 0), end_of(path[i - 1], 1)});
    const Vec3d way =
        vec::sub(vec::add(end_of(path[i - 1], 0), end_of(path[i - 1], 1)), vec::add(end_of(path[i], 0), end_of(path[i], 1)));
    const Vec3d backwards = across(way, here);
    if (backwards != Vec3d{}) return turned(backwards, here, first);
  }
  return {};
}

std::vector<ContactTool> faces_of(const Blade& blade) {
  ContactTool face;
  face.shape = ToolShape::blade_face;
  face.size = {blade.thickness, blade.height, blade.length()};
  face.friction = blade.friction;
  face.edges = true;  // it meets patches of the surface, by whose normals a point finds its side
  face.pointer = blade.pointer;
  face.blade = std::make_shared<const Blade>(blade);
  std::vector<ContactTool> both;
  for (const int side : {1, -1}) {
    face.side = side;
    face.name = fmt::format("{} (face {})", blade.name, side > 0 ? 1 : 2);
    both.push_back(face);
  }
  return both;
}

bool is_face(const ContactTool& tool) { return tool.shape == ToolShape::blade_face; }

void drop_blades(Scene& scene) {
  scene.blades.clear();
  std::erase_if(scene.tools, is_face);
}

Pose blade_frame(const Blade& blade, const std::array<Vec3d, 2>& at) {
  const Vec3d z = along(at), first = along({end_of(blade.path[0], 0), end_of(blade.path[0], 1)});
  const Vec3d y = across(turned(blade.back_at_first(), first, z), z), x = vec::cross(y, z);
  const Vec3d middle = vec::mul(vec::add(at[0], at[1]), 0.5);
  return {vec::add(middle, vec::mul(y, blade.height / 2)), turn_of(x, y, z)};
}

FaceSlopes face_slopes(const Vec3d& size) {
  const double rise = kRise * size[1];
  return {0.5 * size[0] / rise, 0.5 * size[0] / std::min(rise, kEnds * size[2])};
}

}  // namespace pliant
