#include "bench/survival/random_vessels.h"

#include <algorithm>

#include "mesh_io/mesh_io.h"

namespace pliant::bench {

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
  if (points.size() < 2) return nlohmann::ordered_json::array();
  const double radius = std::max({size[0], size[1], size[2]}) * dice.logarithmic(0.003, 0.03);
  return nlohmann::ordered_json::array({{{"points", points},
                                         {"radius", radius},
                                         {"wall", radius * dice.uniform(0.1, 0.9)},
                                         {"young", young * dice.logarithmic(1, 300)},
                                         {"density", dice.uniform(0, 1500)}}});
}

}  // namespace pliant::bench
