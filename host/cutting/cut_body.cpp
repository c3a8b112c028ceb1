#include "cutting/cut_body.h"

#include <fmt/format.h>

#include "pliant/error.h"

namespace pliant {
namespace {

/// The corners of a lattice cell from its six tetrahedra (kKuhnTets), which follow each other.
std::array<std::int32_t, 8> corners_of(const std::array<std::int32_t, 4>* tets) {
  std::array<std::int32_t, 8> corners{};
  for (std::size_t t = 0; t < kKuhnTets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) corners[kKuhnTets[t][a]] = tets[t][a];
  }
  return corners;
}

}  // namespace

std::shared_ptr<const CutMesh> cut_mesh(const Solid& solid, const std::string& name) {
  auto mesh = std::make_shared<CutMesh>();
  mesh->rest = solid.nodes;
  if (!solid.lattice_nodes.empty()) {
    mesh->shape = &lattice_cell_shape();
    mesh->material = solid.samples;
    mesh->cells = solid.hexes;
    mesh->fill = solid.fill;
    for (std::size_t t = 0; t < solid.tets.size(); t += kKuhnTets.size()) {
      if (t == 0) mesh->fill.clear();
      mesh->cells.push_back(corners_of(&solid.tets[t]));
      mesh->fill.push_back(solid.fill[t]);
    }
    return mesh;
  }
  if (solid.tets.empty()) {
    throw Error(
        fmt::format("body '{}' is a volume mesh of hexahedra, which cannot be cut; allowed are lattices (\"surface\") and "
                    "volume meshes of tetrahedra",
                    name));
  }
  mesh->shape = &tetrahedron_shape();
  for (const auto& tet : solid.tets) mesh->cells.push_back({tet[0], tet[1], tet[2], tet[3], 0, 0, 0, 0});
  mesh->fill = solid.fill;
  return mesh;
}

}  // namespace pliant
