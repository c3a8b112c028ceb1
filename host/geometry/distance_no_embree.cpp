// Stands in for distance_embree.cpp in a build without Embree.
#include "geometry/distance.h"

namespace pliant {

bool SurfaceDistance::has_embree() { return false; }

std::shared_ptr<const SurfaceDistance::Embree> SurfaceDistance::start_embree(const TriangleMesh&, const vec::Box&) {
  return nullptr;
}

ClosestPoint SurfaceDistance::closest_by_embree(const Vec3d&) const { return {}; }

}  // namespace pliant
