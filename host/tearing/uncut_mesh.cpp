#include "tearing/uncut_mesh.h"

#include <algorithm>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// A shape without its faces: nobody asks for the cells across a face where none is divided, and to find them takes longest.
const CellShape& faceless(bool tets) {
  const auto without = [](CellShape shape) {
    shape.faces = {};
    return shape;
  };
  static const CellShape of_tets = without(tetrahedron_shape()), of_hexes = without(lattice_cell_shape());
  return tets ? of_tets : of_hexes;
}

}  // namespace

std::shared_ptr<const CutMesh> uncut_mesh(const BodyElements& solid) {
  auto mesh = std::make_shared<CutMesh>();
  mesh->shape = &faceless(!solid.tets.empty());
  mesh->rest = solid.nodes;
  mesh->cells = solid.hexes;
  for (const auto& tet : solid.tets) mesh->cells.push_back({tet[0], tet[1], tet[2], tet[3], 0, 0, 0, 0});
  mesh->fill = solid.fill;
  return mesh;
}

double mean_edge(const CutMesh& mesh) {
  constexpr std::size_t kSample = 1000;
  double sum = 0, count = 0;
  for (std::size_t c = 0; c < std::min(mesh.cells.size(), kSample); ++c) {
    for (const auto& [a, b] : mesh.shape->edges) {
      sum += vec::norm(vec::sub(mesh.rest[mesh.cells[c][a]], mesh.rest[mesh.cells[c][b]]));
      ++count;
    }
  }
  return sum / std::max(count, 1.0);
}

}  // namespace pliant
