// The surface of an uncut body as the overlay needs it: closed, wound outward, with edges, cells and winding numbers, all
// decided exactly. Built once.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/predicates.h"

namespace pliant::overlay {

using GridIndex = std::array<std::int32_t, 3>;

/// Cubic cells, with one more around them on every side. Numbers are those of exact points: corner number times 64 plus 0
/// .. 63.
struct CutGrid {
  Vec3d origin{};
  double spacing = 0;
  GridIndex size{};  ///< cells
  [[nodiscard]] std::int64_t number(const GridIndex& corner) const {
    return (static_cast<std::int64_t>(corner[2] + 1) * (size[1] + 3) + corner[1] + 1) * (size[0] + 3) + corner[0] + 1;
  }
  /// Above every number.
  [[nodiscard]] std::size_t numbers() const {
    return static_cast<std::size_t>(size[0] + 3) * static_cast<std::size_t>(size[1] + 3) *
           static_cast<std::size_t>(size[2] + 3);
  }
  [[nodiscard]] Vec3d position(const GridIndex& corner) const {
    return {origin[0] + spacing * corner[0], origin[1] + spacing * corner[1], origin[2] + spacing * corner[2]};
  }
  /// Returns the cell that contains a point, moved into the grid if it is outside.
  [[nodiscard]] GridIndex cell_at(const Vec3d& p) const;
};

/// An edge of the surface: two half-edges of opposite directions.
struct SourceEdge {
  std::int32_t from = 0, to = 0;       ///< vertices, in the direction of the first triangle
  std::array<std::int32_t, 2> face{};  ///< triangles; the first has it as from -> to
};

class SurfaceSource {
 public:
  /// Holes are closed by additional triangles (`fillers` of them, at the end), and inconsistent winding is repaired.
  SurfaceSource(TriangleMesh mesh, const CutGrid& grid);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const CutGrid& grid() const { return grid_; }
  [[nodiscard]] const ExactFrame& frame() const { return frame_; }
  [[nodiscard]] std::int32_t fillers() const { return fillers_; }
  [[nodiscard]] const std::vector<SourceEdge>& edges() const { return edges_; }
  /// Edges of a triangle: i leads from corner i to the next; -1 in triangles with equal corners, which take part in nothing.
  [[nodiscard]] const std::array<std::int32_t, 3>& edges_of(std::int32_t triangle) const { return triangle_edges_[triangle]; }
  [[nodiscard]] const ExactPoint& exact(std::int32_t vertex) const { return exact_[vertex]; }
  [[nodiscard]] ExactPoint exact_corner(const GridIndex& corner) const {
    return frame_.snap(grid_.position(corner), 64 * grid_.number(corner));
  }
  /// All triangles that meet a cell, ascending, with some that pass it closely.
  [[nodiscard]] std::span<const std::int32_t> triangles_at(const GridIndex& cell) const;
  /// How often the surface winds around a corner of the grid.
  [[nodiscard]] int winding(const GridIndex& corner);
  /// 1: the segment from p to q leaves the body through the triangle; -1: it enters; 0: it misses it.
  [[nodiscard]] int crossing(const ExactPoint& p, const ExactPoint& q, std::int32_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return crosses(p, q, exact_[t[0]], exact_[t[1]], exact_[t[2]]);
  }

 private:
  void close_holes();
  void pair_edges();
  void sort_into_cells();

  TriangleMesh mesh_;
  CutGrid grid_;
  ExactFrame frame_;
  std::int32_t fillers_ = 0;
  std::vector<SourceEdge> edges_;
  std::vector<std::array<std::int32_t, 3>> triangle_edges_;
  std::vector<ExactPoint> exact_;
  std::vector<std::int32_t> cell_offset_, cell_triangles_;               ///< triangles of each cell, by its number
  std::unordered_map<std::int64_t, std::vector<std::int8_t>> windings_;  ///< rows of corners along x
};

}  // namespace pliant::overlay
