// A bounding-volume hierarchy over triangles, in double: closest points, boxes, segments and winding numbers.
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/vec.h"

namespace pliant {

struct ClosestPoint {
  double distance = HUGE_VAL;  ///< [m], never negative
  std::int32_t triangle = -1;
  Vec3d point{};
};

/// Closest point of triangle (a, b, c) to p, by the Voronoi regions of its features (Ericson 2005, section 5.1.5).
Vec3d closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Ties go to the lowest triangle index, so that every traversal order gives the same answer.
  /// `within`: a point that is not nearer than this is not looked for; its triangle is -1 then.
  [[nodiscard]] ClosestPoint closest(const Vec3d& p, double within = HUGE_VAL) const;

  /// Generalised winding number: 1 inside a closed outward surface, 0 outside, smooth across holes. Nearby triangles give
  /// their exact solid angle (van Oosterom and Strackee 1983), far clusters the first two terms of the expansion of
  /// Barill et al. 2018 (1e-3 absolute as a rule, 2e-2 at worst).
  [[nodiscard]] double winding(const Vec3d& p) const;

  /// Indices of the triangles whose bounding boxes overlap `box`, ascending.
  void overlapping(const vec::Box& box, std::vector<std::int32_t>& out) const;

  /// True if the open segment from p to q meets a triangle.
  [[nodiscard]] bool blocked(const Vec3d& p, const Vec3d& q) const;

  [[nodiscard]] const vec::Box& bounds() const { return nodes_.front().box; }

 private:
  struct Node {
    vec::Box box;
    std::int32_t first = 0;  ///< leaf: first triangle in order_
    std::int32_t count = 0;  ///< leaf: number of triangles; 0 in inner nodes
    std::int32_t right = 0;  ///< inner: right child; the left one follows the node
  };
  /// Moments of the area vectors of a node's triangles about their area centroid.
  struct Far {
    Vec3d centre{};
    double reach2 = 0;               ///< squared distance beyond which the expansion is used [m^2]
    Vec3d area{};                    ///< sum of area vectors [m^2]
    std::array<double, 9> moment{};  ///< sum of (centroid - centre) (x) area vector [m^3], rows: offset
  };
  struct Triangle {
    Vec3d a, b, c;
  };
  std::int32_t build(std::vector<Vec3d>& centroids, std::int32_t first, std::int32_t count);
  Far far_field(std::int32_t first, std::int32_t count, const vec::Box& box) const;
  /// Visits the nodes for which open(node) holds and calls visit(i) for their triangles in tree order i, until one returns
  /// true; returns whether one did.
  template <class Open, class Visit>
  bool descend(Open&& open, Visit&& visit) const;

  std::vector<Node> nodes_;
  std::vector<Far> far_;
  std::vector<std::int32_t> order_;  ///< tree order -> index in the mesh
  std::vector<Triangle> triangles_;  ///< by index in the mesh while building, in tree order afterwards
};

}  // namespace pliant
