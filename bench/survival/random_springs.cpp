#include "bench/survival/random_springs.h"

#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"

namespace pliant::bench {

using Json = nlohmann::ordered_json;

void add_random_springs(Dice dice, const std::filesystem::path& mesh, double young, double extent, Json& body) {
  if (!dice.chance(0.2)) return;
  const VolumeMesh elements = read_volume(mesh);
  const auto any_node = [&] { return elements.tets[dice.below(elements.tets.size())][dice.below(4)]; };
  const bool tense = dice.chance(0.4);
  Json rows = Json::array();
  for (std::size_t i = 0, count = static_cast<std::size_t>(dice.logarithmic(10, 200)); i < 20 * count && rows.size() < count;
       ++i) {
    const std::int32_t from = any_node(), to = any_node();
    const double length =
        vec::norm(vec::sub(elements.vertices[static_cast<std::size_t>(to)], elements.vertices[static_cast<std::size_t>(from)]));
    if (!(length > 0) || length > 0.3 * extent) continue;
    rows.push_back({from, to, dice.logarithmic(0.3, 3)});
    if (tense) rows.back().push_back(length * dice.uniform(0.7, 1.05));
  }
  if (rows.empty()) return;
  const double stiffness = young * extent * dice.logarithmic(1e-4, 0.03);
  Json spring{{"law", "linear"}, {"stiffness", stiffness}};
  if (dice.chance(0.3)) spring = {{"law", "measured"}, {"a", 0.3 / (stiffness * extent)}, {"b", 1 / stiffness}};
  if (dice.chance(0.3)) spring["slack"] = true;
  body["springs"] = Json::array({{{"nodes", rows}, {"spring", spring}}});
}

}  // namespace pliant::bench
