// What is wrong with the surfaces of a scene, found while its Model is built.
#pragma once
#include <string>
#include <vector>

#include "mesh_io/surface_report.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// Of one body that is a lattice in a surface.
struct SurfaceCheck {
  std::string body;
  SurfaceReport report;
  Crossings crossings;
  std::vector<std::string> warnings;  ///< sentences for the user; none for a sound surface
};

/// make_body_mesh, and what its surface was; a body of a volume mesh leaves `report` as it is.
BodyMesh make_body_mesh(const Body& body, SurfaceReport& report);

/// build_model(scene), and a SurfaceCheck for each body that has a surface. Looks for triangles that pass through each other,
/// too.
Model build_model(const Scene& scene, std::vector<SurfaceCheck>& checks);

}  // namespace pliant
