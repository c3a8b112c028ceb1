// Shapes of tools, and the signed distances of meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/distance.h"
#include "geometry/parallel.h"
#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "model/contact/contact.h"
#include "model/contact/tool_sequence.h"
#include "pliant/error.h"
#include "scene/blade_face.h"

namespace pliant {
namespace {

void load_mesh(const ContactTool& tool, ToolForm& form) {
  const SurfaceDistance surface(read_tool_mesh(tool, tool.mesh));
  check_closed(tool, tool.mesh, surface);
  vec::Box box;
  for (const Vec3d& v : surface.mesh().vertices) {
    box.extend(v);
    form.reach = std::max(form.reach, vec::norm(v));
  }
  form.thickness = mesh_thickness(surface.mesh());
  form.grid = lay_grid(box, form.thickness);
  append_distances(surface, form);
  form.surface = surface.mesh();
}

double grid_distance(const ToolForm& form, const Vec3d& y, std::int32_t frame) {
  const GridSample sample = interpolate(form.grid, form.distance.data() + frame * form.grid.nodes(), y);
  return sample.beyond == Vec3d{} ? sample.value : vec::norm(sample.beyond) + kToolGridBeyond * form.grid.spacing;
}

}  // namespace

double mesh_thickness(const TriangleMesh& mesh) {
  double volume = 0, area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    volume += vec::dot(a, vec::cross(b, c)) / 6;
    area += vec::norm(vec::cross(vec::sub(b, a), vec::sub(c, a))) / 2;
  }
  return area > 0 ? 2 * std::abs(volume) / area : 1e30;
}

ToolForm tool_form(const ContactTool& tool) {
  ToolForm form;
  form.shape = tool.shape;
  form.edges = tool.edges;
  form.grips = tool.grip.has_value();
  form.radius = tool.radius;
  form.first = tool.first;
  form.second = tool.second;
  switch (tool.shape) {
    case ToolShape::sphere:
      form.reach = tool.radius;
      break;
    case ToolShape::capsule:
      form.reach = std::max(vec::norm(tool.first), vec::norm(tool.second)) + tool.radius;
      break;
    case ToolShape::box:
      form.second = vec::mul(tool.size, 0.5);
      form.reach = vec::norm(form.second);
      break;
    case ToolShape::blade_face: {
      const FaceSlopes slopes = face_slopes(tool.size);
      form.first = {static_cast<double>(tool.side), slopes.up, slopes.along};
      form.second = vec::mul(tool.size, 0.5);
      form.reach = vec::norm(form.second);
      break;
    }
    case ToolShape::half_space:
      form.second = vec::mul(tool.second, 1 / vec::norm(tool.second));
      break;
    case ToolShape::mesh:
      load_mesh(tool, form);
      break;
    case ToolShape::sequence:
      load_sequence(tool, form);
      break;
  }
  return form;
}

double tool_distance(const ToolForm& form, const Vec3d& y, const ToolMoment& moment) {
  switch (form.shape) {
    case ToolShape::sphere:
      return vec::norm(y) - form.radius;
    case ToolShape::capsule: {
      const Vec3d d = vec::sub(form.second, form.first), from = vec::sub(y, form.first);
      const double t = std::clamp(vec::dot(from, d) / vec::dot(d, d), 0.0, 1.0);
      return vec::norm(vec::sub(from, vec::mul(d, t))) - form.radius;
    }
    case ToolShape::blade_face:
    case ToolShape::box: {
      Vec3d q{}, out{};
      for (std::size_t a = 0; a < 3; ++a) {
        q[a] = std::abs(y[a]) - form.second[a];
        out[a] = std::max(q[a], 0.0);
      }
      const double most = std::max({q[0], q[1], q[2]});
      return most > 0 ? vec::norm(out) : most;
    }
    case ToolShape::half_space:
      return vec::dot(vec::sub(y, form.first), form.second);
    case ToolShape::mesh:
    case ToolShape::sequence:
      break;
  }
  const double here = grid_distance(form, y, moment.frame);
  return moment.share > 0 ? (1 - moment.share) * here + moment.share * grid_distance(form, y, moment.frame + 1) : here;
}

}  // namespace pliant
