// The steps of build_lattice: from a surface to cell parts, from cell parts to nodes, and the embedding of vertices.
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "lattice/lattice.h"
#include "lattice/lattice_cell.h"

namespace pliant {

/// Cells of edge `spacing` around the bounding box, which lies in their middle.
struct Grid {
  Vec3d origin{};
  double spacing = 0;
  std::array<std::int32_t, 3> size{};
  Grid(const vec::Box& box, double spacing);
  [[nodiscard]] bool contains(const std::array<std::int32_t, 3>& cell) const;
};

/// All parts, ordered by (k, j, i) of their cell, and where to find those of a cell. Storage grows with the cells kept.
class Parts {
 public:
  static constexpr int kBlock = 8;  ///< a block is kBlock^3 cells

  /// Throws Error if there are more than max_cells.
  Parts(const SurfaceDistance& surface, const Grid& grid, std::int64_t max_cells);

  /// Indices [first, last) of the parts of a cell; empty outside the grid.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> of(const std::array<std::int32_t, 3>& cell) const;
  /// Remove the parts for which `drop` is not 0.
  void remove(const std::vector<char>& drop);

  std::vector<CellPart> list;
  std::int64_t work = 0;  ///< number of cells and winding-number evaluations: a cost measure, the same on every machine

 private:
  void index_cells();
  [[nodiscard]] std::int64_t block_of(const std::array<std::int32_t, 3>& cell) const;

  Grid grid_;
  std::array<std::int64_t, 3> blocks_{};
  std::vector<std::vector<std::int32_t>> first_;  // per block, per cell: first part or -1; empty blocks hold nothing
};

/// Face contacts between parts of neighbouring cells: material that reaches the same spot of the shared face from both sides.
class Contacts {
 public:
  Contacts(const Parts& parts, const SurfaceDistance& surface, const Grid& grid)
      : parts_(parts), surface_(surface), grid_(grid) {}
  /// `a` and `b` are parts of cells that share a face; b's is the upper one along `axis`.
  [[nodiscard]] bool touch(std::int32_t a, std::int32_t b, int axis) const;
  /// Returns whether mend() joined them. Ties across an edge join parts of cells that share no face.
  [[nodiscard]] bool tied(std::int32_t a, std::int32_t b) const;
  /// Joins parts that sampling separated. Slivers that meet below the lowest sample of their common face are tied if they are
  /// connected around an edge of that face and the edge runs through material. Small fragments of a shell whose main part is
  /// elsewhere are tied to a face neighbour of the same shell; those without one are marked in the result for removal.
  std::vector<char> mend();

 private:
  void bridge();
  void hinge(const std::vector<std::int32_t>& root, const std::vector<char>& loose,
             std::vector<std::pair<std::int32_t, std::int32_t>>& ties) const;
  [[nodiscard]] bool around_edge(std::int32_t a, std::int32_t b, int axis, int across, int side) const;
  [[nodiscard]] std::vector<std::int32_t> fragments() const;
  const Parts& parts_;
  const SurfaceDistance& surface_;
  const Grid& grid_;
  std::vector<std::pair<std::int32_t, std::int32_t>> ties_;  // sorted
};

/// Nodes and cells: parts around a grid point share a node if they are connected through face contacts around that point.
void number_nodes(const Parts& parts, const Contacts& contacts, Lattice& lattice);

/// Embed every vertex in the part whose material it bounds.
std::vector<Embedding> embed_vertices(const SurfaceDistance& surface, const Grid& grid, const Parts& parts);

}  // namespace pliant
