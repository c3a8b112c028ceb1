#include "render/tool_surface.h"

#include "model/contact/tool_mesh.h"

namespace pliant::render {
namespace {

constexpr int kAround = 64;  ///< sides of what is round

}  // namespace

void ToolSurfaces::append(const Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles) {
  const Model& model = simulation.model();
  if (model.tools == nullptr) return;
  if (made_of_ != model.tools) shapes_.clear();
  made_of_ = model.tools;
  for (std::size_t t = shapes_.size(); t < model.tools->size(); ++t) shapes_.push_back(tool_mesh((*model.tools)[t], kAround));
  for (std::size_t t = 0; t < shapes_.size(); ++t) {
    const ToolForm& form = (*model.tools)[t];
    const ToolMoment moment = tool_moment(form, simulation.time());
    const Pose pose = compose(simulation.contact().pose(t, simulation.time()), moment.pose);
    const TriangleMesh& shape =
        form.frames.empty() ? shapes_[t]
                            : form.frames[static_cast<std::size_t>(moment.frame + (moment.share < 0.5 ? 0 : 1))].surface;
    const auto first = static_cast<std::int32_t>(positions.size() / 3);
    for (const Vec3d& y : shape.vertices) {
      for (const double x : place(pose, y)) positions.push_back(static_cast<float>(x));
    }
    for (const auto& corners : shape.triangles) {
      for (const std::int32_t v : corners) triangles.push_back(first + v);
    }
  }
}

}  // namespace pliant::render
