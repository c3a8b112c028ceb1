#include "simulation/contact/tool_samples.h"

#include "geometry/vec.h"

namespace pliant {

std::vector<Vec3d> tool_samples(const ToolForm& form, const ToolMoment& moment, std::size_t most) {
  std::vector<Vec3d> out;
  switch (form.shape) {
    case ToolShape::sphere:
      return {Vec3d{}};
    case ToolShape::capsule:
      for (std::size_t i = 0; i < most; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(most - 1);
        out.push_back(vec::add(vec::mul(form.first, 1 - s), vec::mul(form.second, s)));
      }
      return out;
    case ToolShape::box: {  // corners, centres of edges and faces, and the centre
      for (int i = 0; i < 27; ++i)
        out.push_back({(i % 3 - 1) * form.second[0], (i / 3 % 3 - 1) * form.second[1], (i / 9 - 1) * form.second[2]});
      return out;
    }
    case ToolShape::half_space:
    case ToolShape::blade_face:
      return out;
    case ToolShape::mesh:
    case ToolShape::sequence:
      break;
  }
  const auto frame = static_cast<std::size_t>(moment.frame);
  const TriangleMesh& mesh = form.frames.empty() ? form.surface : form.frames[frame].surface;
  const std::size_t every = mesh.vertices.size() / most + 1;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += every) out.push_back(mesh.vertices[v]);
  return out;
}

}  // namespace pliant
