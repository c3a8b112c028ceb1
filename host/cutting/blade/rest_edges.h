// The edges of a body at rest, ready to be crossed by triangles. At rest nothing moves, so this is built once.
#pragma once
#include <bit>
#include <span>
#include <vector>

#include "cutting/topology/cut_topology.h"
#include "geometry/predicates.h"
#include "geometry/spatial_hash.h"

namespace pliant {

/// The number of a blade's point: the same for the same coordinates, so that triangles that meet there agree in every call.
std::int64_t blade_point_number(const Vec3d& p);

class RestEdges {
 public:
  RestEdges(const CutMesh& mesh, double edge);

  /// Call visit(pair, t) for each edge of the mesh that the triangle [m] crosses, t being the share of the way from the lower
  /// node to the higher one. An edge comes once. Touching counts as in crossed_edges (blade.h).
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
  /// Tells cells that lie on one side of a triangle's plane, in steps of the exact grid, without a look at their corners.
  class Plane {
   public:
    explicit Plane(const std::array<ExactPoint, 3>& t);
    /// Whether a box around `middle` that extends by `reach` along each axis has all its points on one side. Errs towards no.
    [[nodiscard]] bool misses(const Vec3d& middle, const Vec3d& reach) const;

   private:
    Vec3d base_{}, normal_{}, error_{};
  };
  [[nodiscard]] double place(const NodePair& pair, const std::array<Vec3d, 3>& t) const;
  /// Of the triangle that is looked at: found once for all edges at the node.
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
  std::uint32_t triangles_ = 0;           ///< looked at so far
  std::vector<std::uint32_t> own_edges_;  ///< of each cell, as bits: those that no cell before it has
  std::vector<Vec3d> middle_, reach_;     ///< of each cell, in steps of the exact grid
  SpatialHash hash_;                      ///< cells
};

}  // namespace pliant
