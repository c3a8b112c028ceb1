#include "geometry/distance.h"

#include <utility>

#include "pliant/error.h"

namespace pliant {

namespace {

TriangleMesh oriented(TriangleMesh mesh, OrientationReport& report) {
  report = orient_outward(mesh);
  return mesh;
}

}  // namespace

SurfaceDistance::SurfaceDistance(TriangleMesh mesh, DistanceEngine engine)
    : mesh_(oriented(std::move(mesh), orientation_)), tree_(mesh_) {
  if (engine == DistanceEngine::embree && !has_embree()) {
    throw Error(ErrorCode::bad_input,
                "closest points by Embree were requested, but this build has no Embree; use the automatic engine");
  }
  if (!orientation_.closed()) {
    TriangleMesh edges;
    edges.vertices = mesh_.vertices;
    for (const auto& [a, b] : orientation_.rim) edges.triangles.push_back({a, b, b});
    rim_ = std::make_unique<TriangleTree>(edges);
  }
  if (engine != DistanceEngine::own && has_embree()) embree_ = start_embree(mesh_, tree_.bounds());
}

ClosestPoint SurfaceDistance::closest(const Vec3d& p) const {
  if (embree_) {
    // Far away the float query position would be coarser than the slack; the own tree has no such limit.
    const Vec3d extent = vec::sub(tree_.bounds().upper, tree_.bounds().lower);
    if (tree_.bounds().distance2(p) <= vec::dot(extent, extent)) {
      const ClosestPoint best = closest_by_embree(p);
      if (best.triangle >= 0) return best;
    }
  }
  return tree_.closest(p);
}

}  // namespace pliant
