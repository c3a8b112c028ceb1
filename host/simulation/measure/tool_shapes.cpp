#include "simulation/measure/tool_shapes.h"

#include <cmath>

#include "geometry/vec.h"
#include "model/contact/tool_mesh.h"

namespace pliant {

TriangleMesh shape_at(const ToolForm& form, const TriangleMesh& fixed, double time) {
  if (form.frames.empty()) return fixed;
  const ToolMoment moment = tool_moment(form, time);
  TriangleMesh mesh = form.frames[static_cast<std::size_t>(moment.frame) + (moment.share < 0.5 ? 0U : 1U)].surface;
  for (Vec3d& v : mesh.vertices) v = place(moment.pose, v);
  return mesh;
}

TriangleMesh ToolShapes::own(const Simulation& simulation, std::size_t tool) {
  const std::shared_ptr<const ToolForms>& forms = simulation.model().tools;
  if (made_of_ != forms) fixed_.clear();
  made_of_ = forms;
  for (std::size_t t = fixed_.size(); t < forms->size(); ++t) {
    const ToolForm& form = (*forms)[t];
    fixed_.push_back(volume_ ? tool_mesh_of_volume(form, around_) : tool_mesh(form, around_));
  }
  return shape_at((*forms)[tool], fixed_[tool], simulation.time());
}

TriangleMesh ToolShapes::placed(const Simulation& simulation, std::size_t tool) {
  TriangleMesh mesh = own(simulation, tool);
  const Pose pose = simulation.contact().pose(tool, simulation.time());
  for (Vec3d& v : mesh.vertices) v = place(pose, v);
  return mesh;
}

TriangleMesh plane_around(const ToolForm& form, const Pose& pose, const vec::Box& box) {
  const double wide = vec::norm(vec::sub(box.upper, box.lower));
  if (form.shape != ToolShape::half_space || !(wide > 0)) return {};
  const Vec3d up = form.second, middle = place_back(pose, vec::mul(vec::add(box.lower, box.upper), 0.5));
  const Vec3d foot = vec::sub(middle, vec::mul(up, tool_distance(form, middle)));
  const Vec3d helper = std::abs(up[0]) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d side = vec::cross(up, helper);
  side = vec::mul(side, 1.5 * wide / vec::norm(side));
  const Vec3d other = vec::cross(up, side);
  TriangleMesh mesh;
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.vertices.push_back(vec::add(foot, vec::add(vec::mul(side, a), vec::mul(other, b))));
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace pliant
