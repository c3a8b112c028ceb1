// Signed distance and inside test for surfaces as they come: with holes, self-intersections and inconsistent winding.
#pragma once
#include <memory>

#include "geometry/orient.h"
#include "geometry/triangle_tree.h"

namespace pliant {

/// Who answers closest-point queries. Both give the same distances: Embree culls in float with a margin, but the
/// point-triangle distances themselves are always computed in double.
enum class DistanceEngine { automatic, embree, own };

class SurfaceDistance {
 public:
  /// Copies the mesh and orients it outward (see orient_outward). Throws Error if it has no triangles, or if Embree is
  /// requested by name but absent.
  explicit SurfaceDistance(TriangleMesh mesh, DistanceEngine engine = DistanceEngine::automatic);
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;

  static bool has_embree();

  /// Unsigned distance [m] to the nearest triangle, that triangle and its nearest point.
  [[nodiscard]] ClosestPoint closest(const Vec3d& p) const;
  /// Generalised winding number of the outward mesh.
  [[nodiscard]] double winding(const Vec3d& p) const { return tree_.winding(p); }
  /// |winding| > 0.5: holes are closed by the half-level surface of the winding number, overlaps count as inside.
  [[nodiscard]] bool inside(const Vec3d& p) const { return std::abs(winding(p)) > 0.5; }
  /// Distance to the nearest rim edge [m]; infinite if the surface is closed.
  [[nodiscard]] double rim_distance(const Vec3d& p) const { return rim_ ? rim_->closest(p).distance : HUGE_VAL; }
  /// [m], negative inside.
  [[nodiscard]] double signed_distance(const Vec3d& p) const { return inside(p) ? -closest(p).distance : closest(p).distance; }

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const OrientationReport& orientation() const { return orientation_; }
  [[nodiscard]] const TriangleTree& tree() const { return tree_; }

 private:
  struct Embree;  // distance_embree.cpp, or distance_no_embree.cpp
  static std::shared_ptr<const Embree> start_embree(const TriangleMesh& surface, const vec::Box& box);
  [[nodiscard]] ClosestPoint closest_by_embree(const Vec3d& p) const;

  OrientationReport orientation_;  // before mesh_, whose initialiser fills it
  TriangleMesh mesh_;
  TriangleTree tree_;
  std::unique_ptr<TriangleTree> rim_;  // rim edges as triangles without area
  std::shared_ptr<const Embree> embree_;
};

}  // namespace pliant
