// Rigid registration of the surfaces of a tool that changes its shape.
#pragma once
#include <functional>
#include <optional>

#include "geometry/distance.h"
#include "geometry/mesh.h"
#include "scene/contact_tool.h"

namespace pliant {

/// Centroid of the volume inside a closed surface.
Vec3d centroid(const TriangleMesh& mesh);

/// Where the surface is, seen from a point.
struct NearSurface {
  Vec3d normal{};       ///< unit
  double gap = 0;       ///< along this normal [m]
  double distance = 0;  ///< to the closest point [m]
};
/// Returns nothing for a point that does not count.
using FindSurface = std::function<std::optional<NearSurface>(const Vec3d&)>;

/// Limits of the cost of a registration.
struct RegistrationEffort {
  std::size_t points = 2000;
  int iterations = 30;
};

/// Returns the pose, starting from `guess`, at which the points of `mesh` fit a surface best, weighted by area. Uses iterated
/// closest points, point to plane (Chen and Medioni 1992). Undetermined motions, such as the rotation of a sphere, stay as in
/// the guess. `centre`, `radius`: of the surface [m].
Pose registered(const TriangleMesh& mesh, const FindSurface& find, const Vec3d& centre, double radius, const Pose& guess,
                const RegistrationEffort& effort = {});

/// The same to a mesh.
Pose registered(const TriangleMesh& mesh, const SurfaceDistance& surface, const Pose& guess);

/// A guess for registered(): the orientation of the surface before, and its centroid where that of `mesh` is.
Pose registration_guess(const TriangleMesh& mesh, const TriangleMesh& before, const Pose& pose_before);

}  // namespace pliant
