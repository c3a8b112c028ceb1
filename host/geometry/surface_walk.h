// The movement of a point over a triangle mesh, told from vertex to vertex (Mendoza and Laugier 2003).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/triangle_tree.h"

namespace pliant {

/// A point on a triangle mesh.
struct SurfacePoint {
  std::int32_t triangle = -1;
  Vec3d at{};  ///< [m]
};

/// A straight part of a way, inside a triangle.
struct WayPart {
  std::int32_t triangle = -1;
  Vec3d from{}, to{};  ///< [m]
};

/// A vertex that a way comes to.
struct VertexOnWay {
  std::int32_t vertex = -1;
  Vec3d at{};        ///< where on the surface it becomes the nearest [m]
  double share = 0;  ///< of the length of the way before that
};

class SurfaceWalk {
 public:
  explicit SurfaceWalk(TriangleMesh mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Closest point of the surface.
  [[nodiscard]] ClosestPoint closest(const Vec3d& p, double within = HUGE_VAL) const { return tree_.closest(p, within); }
  /// The vertex in contact at a point: of those in whose 1-ring it lies, which are the corners of its triangle, the nearest; of
  /// equally near ones that with the lowest number.
  [[nodiscard]] std::int32_t vertex_at(const SurfacePoint& p) const;
  /// The way from one point to another over the surface, along its section with the plane that holds both points and the mean
  /// of the normals there: a geodesic where the surface is plane, close to one where the points are. Of the two ways around,
  /// the shorter. Empty if it would be longer than `most` [m], leaves an open surface, or comes to an edge with more than two
  /// triangles, and between opposite normals along the line from one point to the other, where no plane is the right one.
  [[nodiscard]] std::optional<std::vector<WayPart>> way(const SurfacePoint& from, const SurfacePoint& to, double most) const;
  /// The vertices that are in contact one after the other along a way that begins at vertex `first`, without this one.
  [[nodiscard]] std::vector<VertexOnWay> vertices(const std::vector<WayPart>& way, std::int32_t first) const;

 private:
  struct Section;
  [[nodiscard]] std::optional<std::vector<WayPart>> march(const SurfacePoint& from, const SurfacePoint& to,
                                                          const Section& section, int exit, double most) const;
  [[nodiscard]] bool holds(std::int32_t triangle, const SurfacePoint& p) const;
  [[nodiscard]] std::array<Vec3d, 3> corners(std::int32_t triangle) const;

  TriangleMesh mesh_;
  TriangleTree tree_;
  std::vector<std::array<std::int32_t, 3>>
      next_;  ///< the triangle across the edge from corner k to k + 1; -1: none, or several
};

}  // namespace pliant
