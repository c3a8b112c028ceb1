#include "cli/mesh_regions.h"

#include <fmt/format.h>

#include "mesh_io/mesh_io.h"
#include "mesh_io/mesh_tags.h"

namespace pliant::cli {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

nlohmann::ordered_json tell_mesh_regions(const Body& body, const Common& common) {
  if (body.mesh.empty()) return nullptr;
  constexpr std::size_t most = 1000;
  MeshTags tags;
  (void)read_volume(body.mesh, body.scale, body.translate, &tags);
  Json out = Json::array();
  for (const MeshTags::Array& array : tags.arrays) {
    const std::vector<MeshTags::Region> regions = tags.regions(array);
    const bool usual = tags.find("") == &array;
    Json row{{"data", array.name}, {"usual", usual}, {"numbers", regions.size()}, {"regions", Json::array()}};
    for (std::size_t i = 0; i < regions.size() && regions.size() <= most; ++i) {
      const MeshTags::Region& r = regions[i];
      Json region{{"region", r.number}, {"dimension", r.dimension}, {"cells", r.cells}};
      if (!r.name.empty()) region["name"] = r.name;
      row["regions"].push_back(std::move(region));
    }
    out.push_back(std::move(row));
    const std::string list = regions.size() <= most ? MeshTags::listed(regions) : fmt::format("{} numbers", regions.size());
    common.print(fmt::format("  regions of \"{}\"{}: {}", array.name, usual ? "" : " (with \"data\")", list));
  }
  return out;
}

}  // namespace pliant::cli
