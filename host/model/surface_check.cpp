#include "model/surface_check.h"

#include <fmt/format.h>

#include <cmath>

namespace pliant {
namespace {

constexpr double kNodesApart = 0.02;  // tolerance of the search in build_lattice

}  // namespace

Model build_model(const Scene& scene, std::vector<SurfaceCheck>& checks) {
  std::vector<BodyMesh> solids;
  std::vector<std::size_t> number;  // of the body of each check
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    SurfaceCheck check;
    solids.push_back(make_body_mesh(body, check.report));
    if (!body.has_lattice()) continue;
    check.body = body.name;
    check.crossings = crossings_of({solids.back().surface, solids.back().triangles}, check.report.shell);
    checks.push_back(std::move(check));
    number.push_back(b);
  }
  Model model = build_model(scene, solids);
  for (std::size_t c = 0; c < checks.size(); ++c) {
    const ModelBody& body = model.bodies[number[c]];
    checks[c].warnings = surface_warnings(checks[c].report, checks[c].crossings, body.volume);
    const auto nodes = static_cast<double>(body.slot.size()),
               wanted = static_cast<double>(scene.bodies[number[c]].lattice.nodes);
    if (wanted > 0 && std::abs(nodes / wanted - 1) > kNodesApart) {
      checks[c].warnings.push_back(fmt::format("\"lattice\" requests {} nodes; the nearest lattice found has {} ({:+.1f} %)",
                                               wanted, nodes, 100 * (nodes / wanted - 1)));
    }
  }
  return model;
}

}  // namespace pliant
