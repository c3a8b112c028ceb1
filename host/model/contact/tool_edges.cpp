// Edge points of tools that are thin compared to the distance between contact points.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "geometry/vec.h"
#include "model/contact/contact.h"

namespace pliant {
namespace {

/// Extent of a patch relative to the distance between points: half a diagonal is 0.71, and points are not centred.
constexpr double kReach = 0.8;
/// Minimum extent of the patch of a point with little surface, relative to the same distance.
constexpr double kLeastSide = 0.6;
/// Round tools with a radius below this many distances between points can slip through between them where tissue is
/// stretched.
constexpr double kThin = 1.5;
/// Edges of a mesh whose faces meet at less than this cosine are sharp.
constexpr double kSharp = 0.866;
/// Maximum number of edges of a mesh; the longest are used.
constexpr std::size_t kMostEdges = 512;

/// In a tool's frame [m].
struct ToolEdge {
  Vec3d first{}, second{};
  double radius = 0;
};
double length_of(const ToolEdge& e) { return vec::norm(vec::sub(e.second, e.first)); }

/// The rim of a plate, reduced where two sizes are equal: rounded, with half its thickness as the radius.
std::vector<ToolEdge> rim_of_box(const Vec3d& half) {
  const std::size_t thin = static_cast<std::size_t>(std::min_element(half.begin(), half.end()) - half.begin());
  const std::size_t one = (thin + 1) % 3, two = (thin + 2) % 3;
  const double radius = half[thin], a = half[one] - radius, b = half[two] - radius;
  std::vector<ToolEdge> edges;
  const auto add = [&](double a0, double b0, double a1, double b1) {
    ToolEdge e;
    e.radius = radius;
    e.first[one] = a0, e.first[two] = b0;
    e.second[one] = a1, e.second[two] = b1;
    edges.push_back(e);
  };
  add(-a, -b, a, -b);
  if (b > 0) add(a, b, -a, b);
  if (a > 0 && b > 0) {
    add(a, -b, a, b);
    add(-a, b, -a, -b);
  }
  if (!(a > 0) && b > 0) edges = {edges[0]}, edges[0].second[two] = b;
  return edges;
}

std::vector<ToolEdge> sharp_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<Vec3d>> sides;
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3d normal = vec::cross(vec::sub(b, a), vec::sub(c, a));
    const double length = vec::norm(normal);
    if (!(length > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k) sides[std::minmax({t[k], t[(k + 1) % 3]})].push_back(vec::mul(normal, 1 / length));
  }
  std::vector<ToolEdge> edges;
  for (const auto& [ends, normals] : sides) {
    if (normals.size() == 2 && vec::dot(normals[0], normals[1]) > kSharp) continue;
    edges.push_back({mesh.vertices[ends.first], mesh.vertices[ends.second], 0});
  }
  if (edges.size() > kMostEdges) {
    std::stable_sort(edges.begin(), edges.end(),
                     [](const ToolEdge& a, const ToolEdge& b) { return length_of(a) > length_of(b); });
    edges.resize(kMostEdges);
  }
  return edges;
}

std::vector<ToolEdge> edges_of(const ToolForm& form, double apart) {
  switch (form.shape) {
    case ToolShape::sphere:
      if (form.radius < kThin * apart) return {{{}, {}, form.radius}};
      break;
    case ToolShape::capsule:
      if (form.radius < kThin * apart) return {{form.first, form.second, form.radius}};
      break;
    case ToolShape::box:
      if (*std::min_element(form.second.begin(), form.second.end()) < apart) return rim_of_box(form.second);
      break;
    case ToolShape::mesh:
      if (form.thickness < apart) return sharp_edges(form.surface);
      break;
    case ToolShape::half_space:
    case ToolShape::sequence:
    case ToolShape::blade_face:
      break;
  }
  return {};
}

}  // namespace

double ContactPoints::reach(std::size_t i) const { return kReach * std::max(std::sqrt(area[i]), kLeastSide * apart[i]); }

std::vector<EdgePoint> edge_points(const ToolForm& form, const ContactPoints& points) {
  std::vector<EdgePoint> out;
  if (!form.edges) return out;
  const double apart = points.spacing / 2;
  std::set<Vec3d> seen;
  for (const ToolEdge& e : edges_of(form, apart)) {
    const int parts = static_cast<int>(std::ceil(length_of(e) / apart));
    for (int k = 0; k <= parts; ++k) {
      const double t = parts > 0 ? static_cast<double>(k) / parts : 0;
      const Vec3d place = vec::add(vec::mul(e.first, 1 - t), vec::mul(e.second, t));
      if (seen.insert(place).second) out.push_back({place, e.radius});
    }
  }
  return out;
}

}  // namespace pliant
