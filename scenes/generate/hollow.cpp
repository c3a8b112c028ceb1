#include "scenes/generate/hollow.h"

#include <algorithm>
#include <map>

#include "geometry/disjoint_sets.h"
#include "geometry/distance.h"
#include "pliant/error.h"
#include "scenes/generate/surface_nets.h"

namespace pliant {
namespace {

/// The triangles of the component with most of them.
std::vector<std::array<std::int32_t, 3>> largest_component(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::map<std::int32_t, std::vector<std::array<std::int32_t, 3>>> parts;
  for (const auto& t : mesh.triangles) parts[sets.find(t[0])].push_back(t);
  const auto largest = std::max_element(parts.begin(), parts.end(),
                                        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return largest == parts.end() ? std::vector<std::array<std::int32_t, 3>>{} : largest->second;
}

}  // namespace

TriangleMesh make_hollow(const TriangleMesh& solid, double wall, double step) {
  const SurfaceDistance distance(solid);
  vec::Box box;
  for (const Vec3d& v : solid.vertices) box.extend(v);
  const TriangleMesh cavity = surface_nets([&](const Vec3d& p) { return distance.signed_distance(p) + wall; }, box, step);
  const auto triangles = largest_component(cavity);
  if (triangles.empty()) throw Error(ErrorCode::bad_input, "a body is too thin for its wall");
  TriangleMesh hollow = solid;
  std::map<std::int32_t, std::int32_t> number;
  for (const auto& t : triangles) {
    std::array<std::int32_t, 3> inward{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [at, added] = number.try_emplace(t[c], static_cast<std::int32_t>(hollow.vertices.size()));
      if (added) hollow.vertices.push_back(cavity.vertices[t[c]]);
      inward[2 - c] = at->second;
    }
    hollow.triangles.push_back(inward);
  }
  return hollow;
}

}  // namespace pliant
