// The undeformed edges of a body, prepared for intersection with triangles. Built once.
#pragma once
#include <bit>
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"
#include "geometry/predicates.h"
#include "geometry/spatial_hash.h"

namespace pliant {

/// Id of a blade's point, the same for the same coordinates, so that triangles that meet there are consistent across calls.
std::int64_t blade_point_number(const Vec3d& p);

class RestEdges {
 public:
  RestEdges(const CutMesh& mesh, double edge);

  /// Calls visit(pair, t) once for each edge of the mesh that the triangle [m] crosses, with the fraction t of the way from
  /// the lower node to the higher one. Touching is treated as in crossed_edges (blade.h).
  template <class Visit>
  void crossed(const std::array<Vec3d, 3>& triangle, Visit&& visit) {
    std::array<ExactPoint, 3> tri;
    vec::Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      tri[k] = frame_.snap(triangle[k], blade_point_number(triangle[k]));
      box.extend(triangle[k]);
    }
    for (int a = 0; a < 3; ++a) {
      box.lower[a] -= 4 * frame_.step();
      box.upper[a] += 4 * frame_.step();
    }
    const Plane plane(tri);
    ++triangles_;
    hash_.query(box, [&](std::int32_t cell) {
      if (own_edges_[cell] == 0 || plane.misses(middle_[cell], reach_[cell])) return;
      const auto& nodes = mesh_.cells[cell];
      for (std::uint32_t rest = own_edges_[cell]; rest != 0; rest &= rest - 1) {
        const auto& [i, j] = mesh_.shape->edges[std::countr_zero(rest)];
        if (side(nodes[i], tri) == side(nodes[j], tri)) continue;
        const NodePair pair = node_pair(nodes[i], nodes[j]);
        if (passes(node_[pair[0]], node_[pair[1]], tri[0], tri[1], tri[2])) visit(pair, place(pair, triangle));
      }
    });
  }

 private:
  /// Detects cells on one side of a triangle's plane, in steps of the exact grid, without testing their corners.
  class Plane {
   public:
    explicit Plane(const std::array<ExactPoint, 3>& t);
    /// Returns whether all points of the box around `middle` with half sizes `reach` are on one side. Errors are towards
    /// false.
    [[nodiscard]] bool misses(const Vec3d& middle, const Vec3d& reach) const;

   private:
    Vec3d base_{}, normal_{}, error_{};
  };
  [[nodiscard]] double place(const NodePair& pair, const std::array<Vec3d, 3>& t) const;
  /// Data of the current triangle, computed once per node for all edges.
  [[nodiscard]] int side(std::int32_t node, const std::array<ExactPoint, 3>& tri) {
    Side& known = side_[node];
    if (known.triangle != triangles_) known = {triangles_, orient(tri[0], tri[1], tri[2], node_[node])};
    return known.side;
  }
  struct Side {
    std::uint32_t triangle = 0;
    std::int32_t side = 0;
  };

  const CutMesh& mesh_;
  ExactFrame frame_;
  std::vector<ExactPoint> node_;
  std::vector<Side> side_;                ///< [nodes]
  std::uint32_t triangles_ = 0;           ///< number of triangles tested so far
  std::vector<std::uint32_t> own_edges_;  ///< bits of each cell's edges that no earlier cell has
  std::vector<Vec3d> middle_, reach_;     ///< of each cell, in steps of the exact grid
  SpatialHash hash_;                      ///< cells
};

}  // namespace pliant
