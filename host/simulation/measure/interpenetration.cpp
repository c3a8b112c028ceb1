#include "simulation/measure/interpenetration.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/mesh_overlap.h"
#include "geometry/vec.h"
#include "scene/blade_face.h"

namespace pliant {
namespace {

/// Whether each edge is run as often one way as the other. Vertices in one place at rest are one: seams are no holes.
bool is_closed(const ModelSurface& surface, const ModelBody& body) {
  std::map<Vec3d, std::int32_t> places;
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (std::int32_t t = body.first_triangle; t < body.first_triangle + body.triangles; ++t) {
    std::array<std::int32_t, 3> corner{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t v = surface.triangles[static_cast<std::size_t>(t)][a];
      corner[a] = places.try_emplace(surface.rest[static_cast<std::size_t>(v)], v).first->second;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t from = corner[a], to = corner[(a + 1) % 3];
      if (from < to) ++edges[{from, to}];
      if (to < from) --edges[{to, from}];
    }
  }
  return body.triangles > 0 && std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

/// A half space as a box that holds what is near it: three radii of the tissue to each side of its plane's nearest point.
TriangleMesh half_space_mesh(const ToolForm& form, const Pose& pose, const vec::Box& tissue) {
  const Vec3d middle = place_back(pose, vec::mul(vec::add(tissue.lower, tissue.upper), 0.5));
  const double radius = 0.5 * vec::norm(vec::sub(tissue.upper, tissue.lower)), height = tool_distance(form, middle);
  if (!(radius > 0) || height > radius) return {};
  TriangleMesh mesh = plane_around(form, pose, tissue);
  const double deep = 3 * radius + std::max(0.0, -height);  // as deep as the tissue lies, and further than it is wide
  for (std::int32_t k = 0; k < 4; ++k) {
    mesh.vertices.push_back(vec::sub(mesh.vertices[static_cast<std::size_t>(k)], vec::mul(form.second, deep)));
    const std::int32_t next = (k + 1) % 4;
    mesh.triangles.push_back({k, k + 4, next + 4});
    mesh.triangles.push_back({k, next + 4, next});
  }
  mesh.triangles.push_back({4, 6, 5});
  mesh.triangles.push_back({4, 7, 6});
  for (Vec3d& v : mesh.vertices) v = place(pose, v);
  return mesh;
}

}  // namespace

void Interpenetrations::follow(Simulation& simulation) {
  const std::shared_ptr<const Model> model = simulation.shared_model();
  if (model == model_) return;
  model_ = model;
  closed_.clear();
  for (const ModelBody& body : model->bodies) closed_.push_back(is_closed(model->surface, body) ? 1 : 0);
}

std::vector<Interpenetrations::Part> Interpenetrations::bodies(Simulation& simulation) const {
  const ModelSurface& surface = model_->surface;
  const std::vector<Vec3d> positions = simulation.surface_positions();
  std::vector<Part> parts(model_->bodies.size());
  std::vector<std::int32_t> number(positions.size(), -1);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const ModelBody& body = model_->bodies[b];
    if (closed_[b] == 0 || positions.empty()) continue;
    Part& part = parts[b];
    for (std::int32_t t = body.first_triangle; t < body.first_triangle + body.triangles; ++t) {
      std::array<std::int32_t, 3> corner{};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto v = static_cast<std::size_t>(surface.triangles[static_cast<std::size_t>(t)][a]);
        if (number[v] < 0) {
          number[v] = static_cast<std::int32_t>(part.mesh.vertices.size());
          part.mesh.vertices.push_back(positions[v]);
          part.box.extend(positions[v]);
        }
        corner[a] = number[v];
      }
      part.mesh.triangles.push_back(corner);
    }
    if (!std::all_of(part.mesh.vertices.begin(), part.mesh.vertices.end(), vec::finite)) part = {};
  }
  return parts;
}

std::vector<Interpenetration> Interpenetrations::now(Simulation& simulation) {
  follow(simulation);
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  std::vector<Interpenetration> found;
  if (tools.empty() && model_->bodies.size() < 2) return found;
  const std::vector<Part> parts = bodies(simulation);
  const auto add = [&](const std::string& first, std::size_t b, bool tool, const TriangleMesh& mesh) {
    const MeshOverlap o = mesh_overlap(mesh, parts[b].mesh);
    if (o.volume > 0) found.push_back({first, model_->bodies[b].name, tool, o.volume, o.centroid, o.area, o.depth, o.deepest});
  };
  vec::Box all;
  for (const Part& part : parts) {
    if (!part.mesh.triangles.empty()) all.extend(part.box);
  }
  for (std::size_t t = 0; t < tools.size() && model_->tools != nullptr; ++t) {
    if (is_face(tools[t])) continue;
    const ToolForm& form = (*model_->tools)[t];
    const Pose pose = simulation.contact().pose(t, simulation.time());
    const bool everywhere = form.shape == ToolShape::half_space;
    if (!everywhere && all.distance2(pose.position) > form.reach * form.reach) continue;
    const TriangleMesh mesh = everywhere ? half_space_mesh(form, pose, all) : shapes_.placed(simulation, t);
    for (std::size_t b = 0; b < parts.size(); ++b) add(tools[t].name, b, true, mesh);
  }
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t b = a + 1; b < parts.size(); ++b) {
      if (parts[a].box.overlaps(parts[b].box)) add(model_->bodies[a].name, b, false, parts[a].mesh);
    }
  }
  return found;
}

std::vector<std::string> Interpenetrations::left_out(Simulation& simulation) {
  follow(simulation);
  std::vector<std::string> names;
  const std::vector<Part> parts = bodies(simulation);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (parts[b].mesh.triangles.empty()) names.push_back(model_->bodies[b].name);
  }
  return names;
}

Interpenetration sum_between(const std::vector<Interpenetration>& found, const std::string& first, const std::string& second) {
  Interpenetration sum{first, second};
  Vec3d moment{};
  for (const Interpenetration& i : found) {
    const bool forward = i.first == first && (second.empty() || i.second == second);
    const bool backward = i.second == first && (second.empty() || i.first == second);
    if (!forward && !backward) continue;
    sum.tool = sum.tool || i.tool;
    sum.volume += i.volume;
    moment = vec::add(moment, vec::mul(i.centroid, i.volume));
    for (std::size_t m = 0; m < 2; ++m) sum.area[m] += i.area[forward ? m : 1 - m];
    if (i.depth > sum.depth) sum.depth = i.depth, sum.deepest = i.deepest;
  }
  if (sum.volume > 0) sum.centroid = vec::mul(moment, 1 / sum.volume);
  return sum;
}

}  // namespace pliant
