#include "simulation/contact/tool_samples.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

const TriangleMesh& mesh_of(const ToolForm& form, const ToolMoment& moment) {
  return form.frames.empty() ? form.surface : form.frames[static_cast<std::size_t>(moment.frame)].surface;
}

constexpr int kParts = 8;       ///< of a box, along each axis
constexpr int kMostParts = 32;  ///< of an axis or an edge

bool is_in(const vec::Box& box, const Vec3d& x) { return box.distance2(x) == 0; }

/// The part of a segment within a box: from the first to the second number; none if they are the other way round.
std::array<double, 2> part_within(const vec::Box& box, const Vec3d& a, const Vec3d& b) {
  std::array<double, 2> part{0, 1};
  for (std::size_t c = 0; c < 3; ++c) {
    const double way = b[c] - a[c];
    if (way == 0) {
      if (a[c] < box.lower[c] || a[c] > box.upper[c]) return {1, 0};
      continue;
    }
    const double s = (box.lower[c] - a[c]) / way, t = (box.upper[c] - a[c]) / way;
    part = {std::max(part[0], std::min(s, t)), std::min(part[1], std::max(s, t))};
  }
  return part;
}

void add_segment(const vec::Box& box, const Vec3d& a, const Vec3d& b, double apart, std::vector<Vec3d>& out) {
  const auto [first, last] = part_within(box, a, b);
  if (!(first <= last)) return;
  const double length = (last - first) * vec::norm(vec::sub(b, a));
  const int parts = std::clamp(static_cast<int>(std::ceil(length / apart)), 1, kMostParts);
  for (int i = 0; i <= parts; ++i) {
    const double s = first + (last - first) * i / parts;
    out.push_back(vec::add(vec::mul(a, 1 - s), vec::mul(b, s)));
  }
}

/// Points of the surface of a box of this half size, where it is within another.
void add_box(const vec::Box& box, const Vec3d& half, std::vector<Vec3d>& out) {
  Vec3d low{}, high{};
  for (std::size_t c = 0; c < 3; ++c) {
    low[c] = std::max(-half[c], box.lower[c]);
    high[c] = std::min(half[c], box.upper[c]);
    if (low[c] > high[c]) return;
  }
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts; ++j) {
      for (int k = 0; k <= kParts; k += i == 0 || i == kParts || j == 0 || j == kParts ? 1 : kParts) {
        const std::array<int, 3> at{i, j, k};
        Vec3d x{};
        for (std::size_t c = 0; c < 3; ++c) x[c] = low[c] + (high[c] - low[c]) * at[c] / kParts;
        out.push_back(x);
      }
    }
  }
}

void add_mesh(const TriangleMesh& mesh, const vec::Box& box, double apart, std::size_t most, std::vector<Vec3d>& out) {
  std::vector<Vec3d> all;
  for (const Vec3d& x : mesh.vertices) {
    if (is_in(box, x)) all.push_back(x);
  }
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d &a = mesh.vertices[t[c]], &b = mesh.vertices[t[(c + 1) % 3]];
      if (t[c] < t[(c + 1) % 3] && vec::norm(vec::sub(b, a)) > apart) add_segment(box, a, b, apart, all);
    }
  }
  const std::size_t every = all.size() / most + 1;
  for (std::size_t i = 0; i < all.size(); i += every) out.push_back(all[i]);
}

}  // namespace

std::vector<Vec3d> tool_samples(const ToolForm& form, const ToolMoment& moment, std::size_t most) {
  std::vector<Vec3d> out;
  switch (form.shape) {
    case ToolShape::sphere:
      return {Vec3d{}};
    case ToolShape::capsule:
      for (std::size_t i = 0; i < most; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(most - 1);
        out.push_back(vec::add(vec::mul(form.first, 1 - s), vec::mul(form.second, s)));
      }
      return out;
    case ToolShape::box: {  // corners, centres of edges and faces, and the centre
      for (int i = 0; i < 27; ++i)
        out.push_back({(i % 3 - 1) * form.second[0], (i / 3 % 3 - 1) * form.second[1], (i / 9 - 1) * form.second[2]});
      return out;
    }
    case ToolShape::half_space:
    case ToolShape::blade_face:
      return out;
    case ToolShape::mesh:
    case ToolShape::sequence:
      break;
  }
  const TriangleMesh& mesh = mesh_of(form, moment);
  const std::size_t every = mesh.vertices.size() / most + 1;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += every) out.push_back(mesh.vertices[v]);
  return out;
}

std::vector<Vec3d> tool_samples_in(const ToolForm& form, const ToolMoment& moment, const vec::Box& box, double apart,
                                   std::size_t most) {
  std::vector<Vec3d> out;
  switch (form.shape) {
    case ToolShape::sphere:
      if (is_in(box, {})) out.push_back({});
      break;
    case ToolShape::capsule:
      add_segment(box, form.first, form.second, apart, out);
      break;
    case ToolShape::box:
      add_box(box, form.second, out);
      break;
    case ToolShape::mesh:
    case ToolShape::sequence:
      add_mesh(mesh_of(form, moment), box, apart, most, out);
      break;
    case ToolShape::half_space:
    case ToolShape::blade_face:
      break;
  }
  return out;
}

}  // namespace pliant
