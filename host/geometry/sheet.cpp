#include "geometry/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/defects.h"
#include "geometry/orient.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using EdgeEnds = std::pair<std::int32_t, std::int32_t>;

/// Triangles at an edge, by the direction in which they run along it.
struct EdgeUse {
  int forward = 0, backward = 0;
};

std::map<EdgeEnds, EdgeUse> uses_of(const TriangleMesh& surface) {
  std::map<EdgeEnds, EdgeUse> uses;
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = t[i], b = t[(i + 1) % 3];
      EdgeUse& use = uses[std::minmax(a, b)];
      ++(a < b ? use.forward : use.backward);
    }
  }
  return uses;
}

bool wound_alike(const std::map<EdgeEnds, EdgeUse>& uses) {
  return std::all_of(uses.begin(), uses.end(), [](const auto& u) { return u.second.forward <= 1 && u.second.backward <= 1; });
}

std::string place_text(const Vec3d& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); }

/// Winds the triangles of each part alike, unless they are.
void wind_alike(TriangleMesh& surface, const std::string& name) {
  const std::map<EdgeEnds, EdgeUse> uses = uses_of(surface);
  for (const auto& [edge, use] : uses) {
    if (const int n = use.forward + use.backward; n > 2) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: {} triangles meet at the edge from {} to {}; a sheet has at most two at each edge", name, n,
                              place_text(surface.vertices[edge.first]), place_text(surface.vertices[edge.second])));
    }
  }
  if (wound_alike(uses)) return;
  orient_outward(surface);
  if (!wound_alike(uses_of(surface)))
    throw Error(ErrorCode::bad_input, name + ": the surface has only one side, and a sheet needs two");
}

/// From every vertex to the upper side [m]: along the sum of the normals of its triangles, weighted by their angles there, and
/// longer than half the thickness where they differ, so that the layer is as thick as elsewhere, but at most twice as long.
std::vector<Vec3d> offsets_of(const TriangleMesh& surface, double thickness) {
  std::vector<Vec3d> sum(surface.vertices.size(), Vec3d{});
  std::vector<Vec3d> normals;
  for (const auto& t : surface.triangles) {
    const Vec3d &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    const Vec3d n = vec::cross(vec::sub(b, a), vec::sub(c, a));
    normals.push_back(vec::mul(n, 1 / vec::norm(n)));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d &o = surface.vertices[t[i]], u = vec::sub(surface.vertices[t[(i + 1) % 3]], o),
                  v = vec::sub(surface.vertices[t[(i + 2) % 3]], o);
      const double angle = std::atan2(vec::norm(vec::cross(u, v)), vec::dot(u, v));
      sum[t[i]] = vec::add(sum[t[i]], vec::mul(normals.back(), angle));
    }
  }
  std::vector<double> least(sum.size(), 1);
  for (Vec3d& n : sum) {
    const double length = vec::norm(n);
    n = length > 0 ? vec::mul(n, 1 / length) : Vec3d{};
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t v : surface.triangles[t]) least[v] = std::min(least[v], vec::dot(sum[v], normals[t]));
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = vec::mul(sum[v], thickness / 2 / std::max(least[v], 0.5));
  return sum;
}

double volume_of(const std::vector<Vec3d>& x, const std::array<std::int32_t, 4>& t) {
  const Vec3d u = vec::sub(x[t[1]], x[t[0]]), v = vec::sub(x[t[2]], x[t[0]]), w = vec::sub(x[t[3]], x[t[0]]);
  return vec::dot(u, vec::cross(v, w)) / 6;
}

/// The three tetrahedra of a triangle's prism.
std::array<std::array<std::int32_t, 4>, 3> prism(std::array<std::int32_t, 3> t) {
  const bool odd = (t[0] > t[1]) != ((t[0] > t[2]) != (t[1] > t[2]));
  std::sort(t.begin(), t.end());
  const auto low = [&](std::size_t i) { return 2 * t[i]; };
  const auto high = [&](std::size_t i) { return 2 * t[i] + 1; };
  std::array<std::array<std::int32_t, 4>, 3> tets{
      {{low(0), low(1), low(2), high(2)}, {low(0), low(1), high(2), high(1)}, {low(0), high(1), high(2), high(0)}}};
  for (auto& tet : tets) {
    if (odd) std::swap(tet[0], tet[1]);
  }
  return tets;
}

}  // namespace

VolumeMesh thicken(TriangleMesh surface, double thickness, const std::string& name) {
  wind_alike(surface, name);
  const std::vector<Vec3d> offset = offsets_of(surface, thickness);
  VolumeMesh mesh;
  mesh.vertices.reserve(2 * surface.vertices.size());
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    mesh.vertices.push_back(vec::sub(surface.vertices[v], offset[v]));
    mesh.vertices.push_back(vec::add(surface.vertices[v], offset[v]));
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double area = area_of(surface, static_cast<std::int64_t>(t));
    for (const auto& tet : prism(surface.triangles[t])) {
      // A third of a flat prism is 1; less than a twentieth of that is a fold that the layer does not follow.
      if (volume_of(mesh.vertices, tet) < area * thickness / 60) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: at {} the surface bends too sharply for a sheet of {} m", name,
                                place_text(centroid_of(surface, static_cast<std::int64_t>(t))), thickness));
      }
      mesh.tets.push_back(tet);
    }
  }
  return mesh;
}

}  // namespace pliant
