// Defects of a scene's surfaces, found while its Model is built.
#pragma once
#include <string>
#include <vector>

#include "mesh_io/surface_report.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// Result for a body that is a lattice in a surface.
struct SurfaceCheck {
  std::string body;
  SurfaceReport report;
  Crossings crossings;
  std::vector<std::string> warnings;  ///< sentences for the user; empty for a sound surface
};

/// make_body_mesh that also reports on the surface; for a volume mesh `report` is unchanged.
BodyMesh make_body_mesh(const Body& body, SurfaceReport& report);

/// build_model(scene) that also returns a SurfaceCheck for each body with a surface, including self-intersections.
Model build_model(const Scene& scene, std::vector<SurfaceCheck>& checks);

}  // namespace pliant
