#include "render/tool_surface.h"

#include "simulation/contact/tool_changes.h"

namespace pliant::render {

void ToolSurfaces::append(const Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles) {
  const Model& model = simulation.model();
  if (model.tools == nullptr) return;
  for (std::size_t t = 0; t < model.tools->size(); ++t) {
    if (is_away(simulation.contact().tools()[t], simulation.state(), simulation.time())) continue;
    const TriangleMesh shape = shapes_.placed(simulation, t);
    const auto first = static_cast<std::int32_t>(positions.size() / 3);
    for (const Vec3d& v : shape.vertices) {
      for (const double x : v) positions.push_back(static_cast<float>(x));
    }
    for (const auto& corners : shape.triangles) {
      for (const std::int32_t v : corners) triangles.push_back(first + v);
    }
  }
}

}  // namespace pliant::render
