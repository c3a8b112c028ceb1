#include "bench/survival/random_vessels.h"

#include <algorithm>
#include <array>

#include "mesh_io/mesh_io.h"

namespace pliant::bench {
namespace {

bool holds(const VolumeMesh& mesh, const std::array<std::int32_t, 4>& tet, const Vec3d& x) {
  std::array<Vec3d, 4> to;
  for (std::size_t a = 0; a < 4; ++a) to[a] = vec::sub(mesh.vertices[static_cast<std::size_t>(tet[a])], x);
  const auto volume = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) { return vec::dot(a, vec::cross(b, c)); };
  const double parts[] = {volume(to[1], to[3], to[2]), volume(to[0], to[2], to[3]), volume(to[0], to[3], to[1]),
                          volume(to[0], to[1], to[2])};
  const auto [least, most] = std::minmax_element(std::begin(parts), std::end(parts));
  return *least >= 0 || *most <= 0;
}

/// Whether the mesh has the whole way between two places, as far as 200 places on it tell.
bool holds_way(const VolumeMesh& mesh, const Vec3d& from, const Vec3d& to) {
  constexpr int kPlaces = 200;
  for (int i = 0; i <= kPlaces; ++i) {
    const Vec3d x = vec::add(from, vec::mul(vec::sub(to, from), double(i) / kPlaces));
    if (std::none_of(mesh.tets.begin(), mesh.tets.end(), [&](const auto& tet) { return holds(mesh, tet, x); })) return false;
  }
  return true;
}

}  // namespace

nlohmann::ordered_json random_vessels(Dice& dice, const std::filesystem::path& mesh, const vec::Box& box, double young) {
  const VolumeMesh elements = mesh.empty() ? VolumeMesh{} : read_volume(mesh);
  const Vec3d size = vec::sub(box.upper, box.lower);
  std::vector<Vec3d> points;
  for (std::size_t i = 0, count = 2 + dice.below(4); i < count; ++i) {
    Vec3d place{};
    if (elements.tets.empty()) {
      for (std::size_t c = 0; c < 3; ++c) place[c] = box.lower[c] + dice.uniform(0.3, 0.7) * size[c];
    } else {
      for (const std::int32_t n : elements.tets[dice.below(elements.tets.size())])
        place = vec::add(place, vec::mul(elements.vertices[static_cast<std::size_t>(n)], 0.25));
    }
    if (points.empty() || points.back() != place) points.push_back(place);
  }
  // A vessel ends where the next segment would leave a shape with hollows.
  for (std::size_t i = 1; i < points.size() && !elements.tets.empty(); ++i) {
    if (!holds_way(elements, points[i - 1], points[i])) points.resize(i);
  }
  if (points.size() < 2) return nlohmann::ordered_json::array();
  const double radius = std::max({size[0], size[1], size[2]}) * dice.logarithmic(0.003, 0.03);
  return nlohmann::ordered_json::array({{{"points", points},
                                         {"radius", radius},
                                         {"wall", radius * dice.uniform(0.1, 0.9)},
                                         {"young", young * dice.logarithmic(1, 300)},
                                         {"density", dice.uniform(0, 1500)}}});
}

}  // namespace pliant::bench
