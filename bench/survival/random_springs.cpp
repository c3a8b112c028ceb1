#include "bench/survival/random_springs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"

namespace pliant::bench {

void add_random_springs(Dice dice, const std::filesystem::path& mesh, double young, double extent,
                        nlohmann::ordered_json& body) {
  if (!dice.chance(0.2)) return;
  const VolumeMesh elements = read_volume(mesh);
  const auto any_node = [&] { return elements.tets[dice.below(elements.tets.size())][dice.below(4)]; };
  const bool tense = dice.chance(0.4);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
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
  nlohmann::ordered_json spring{{"law", "linear"}, {"stiffness", stiffness}};
  if (dice.chance(0.3)) spring = {{"law", "measured"}, {"a", 0.3 / (stiffness * extent)}, {"b", 1 / stiffness}};
  if (dice.chance(0.3)) spring["slack"] = true;
  body["springs"] = nlohmann::ordered_json::array({{{"nodes", rows}, {"spring", spring}}});
}

void add_random_joins(Dice dice, const std::filesystem::path& shape, const Vec3d& offset, double young, double extent,
                      nlohmann::ordered_json& scene) {
  if (!dice.chance(0.35)) return;
  const std::string kind = shape.extension().string();
  const std::vector<Vec3d> places = kind == ".obj" ? read_surface(shape).vertices : read_volume(shape).vertices;
  double nearest = HUGE_VAL;
  for (const Vec3d& p : places) {
    for (const Vec3d& q : places) nearest = std::min(nearest, vec::norm(vec::sub(vec::add(q, offset), p)));
  }
  // The nodes of a lattice lie up to a cell outside the surface.
  nlohmann::ordered_json join{{"bodies", {scene["bodies"][0]["name"], scene["bodies"][1]["name"]}},
                              {"distance", nearest + extent * dice.uniform(0.1, 0.15)},
                              {"spring", {{"stiffness", young * extent * dice.logarithmic(1e-4, 0.01)}}}};
  if (dice.chance(0.3)) join["spring"]["slack"] = true;
  if (dice.chance(0.5)) join["break_force"] = young * extent * extent * dice.logarithmic(1e-6, 1e-3);
  scene["joins"] = nlohmann::ordered_json::array({join});
}

}  // namespace pliant::bench
