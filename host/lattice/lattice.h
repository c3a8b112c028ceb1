// A surface filled with cubic cells, and the embedding of its vertices in them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "scene/lattice_spec.h"

namespace pliant {

/// Corner a of a cell lies at (i + (a & 1), j + ((a >> 1) & 1), k + ((a >> 2) & 1)): x fastest, then y, then z.
struct Cell {
  std::array<std::int32_t, 3> index{};        ///< (i, j, k)
  double fill = 1;                            ///< material volume over cell volume, in (0, 1]
  std::array<std::int32_t, 8> nodes{};        ///< into Lattice::nodes
  std::uint64_t samples = ~std::uint64_t{0};  ///< which of its 4 x 4 x 4 samples lie in material (lattice_cell.h)
};

/// Kuhn's subdivision of a cell into six tetrahedra along the diagonal from corner 0 to corner 7: the same in every cell, so
/// that faces match.
inline constexpr std::array<std::array<int, 4>, 6> kKuhnTets{
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

/// A node sits on a grid point; several nodes may share one grid point when parts of the body pass near each other without
/// touching (then `copy` is 1, 2, ...). Copy 0 is the first.
struct LatticeNode {
  std::array<std::int32_t, 3> index{};
  std::int32_t copy = 0;
};

/// Where a surface vertex is embedded: u(vertex) = sum_a weight[a] u(cell.nodes[a]), trilinear.
struct Embedding {
  std::int32_t cell = 0;
  std::array<double, 3> local{};  ///< position in the cell, normally in [0, 1]^3
};

struct Lattice {
  Vec3d origin{};                      ///< position of grid point (0, 0, 0) [m]
  double spacing = 0;                  ///< [m]
  std::array<std::int32_t, 3> size{};  ///< cells along x, y, z of the bounding grid
  std::vector<Cell> cells;             ///< ordered by (k, j, i), copies of one grid cell adjacent
  std::vector<LatticeNode> nodes;      ///< ordered by (k, j, i), then copy
  std::vector<Embedding> embedding;    ///< one per vertex of the surface
  [[nodiscard]] Vec3d position(const LatticeNode& n) const {
    return {origin[0] + spacing * n.index[0], origin[1] + spacing * n.index[1], origin[2] + spacing * n.index[2]};
  }
};

/// Fill `surface` with cells of edge spec.spacing, or find the spacing that gives about spec.nodes nodes: within 2 % where a
/// bounded search finds one, else the nearest that it found. Sheets that bound nothing (geometry/defects.h) are not filled;
/// their vertices are embedded in the nearest cells. Throws Error if the spacing gives no cell or more than `max_cells`.
Lattice build_lattice(const TriangleMesh& surface, const LatticeSpec& spec, std::int64_t max_cells = 100'000'000);

}  // namespace pliant
