#include "simulation/body_overlap.h"

#include <fmt/format.h>

#include <memory>

#include "geometry/distance.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

Vec3d start_of(const Model& model, std::size_t point) {
  const ContactPoints& points = *model.contact;
  Vec3d x = points.rest[point];
  if (model.displacement.empty()) return x;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto slot = static_cast<std::size_t>(points.nodes[point][a]);
    x = vec::add(x, vec::mul(model.displacement[slot], double(points.weights[point][a]) / contact_weight_unit));
  }
  return x;
}

TriangleMesh surface_at_start(const Model& model, std::size_t body) {
  const ModelSurface& s = model.surface;
  const ModelBody& b = model.bodies[body];
  TriangleMesh mesh;
  for (std::size_t v = 0; v < s.rest.size(); ++v) {
    Vec3d x = s.rest[v];
    for (std::size_t a = 0; a < 8 && !model.displacement.empty(); ++a)
      x = vec::add(x, vec::mul(model.displacement[static_cast<std::size_t>(s.nodes[v][a])], s.weights[v][a]));
    mesh.vertices.push_back(x);
  }
  for (std::int32_t t = b.first_triangle; t < b.first_triangle + b.triangles; ++t)
    mesh.triangles.push_back(s.triangles[static_cast<std::size_t>(t)]);
  return mesh;
}

}  // namespace

void refuse_overlap(const Model& model, double allowed) {
  const ContactPoints& points = *model.contact;
  std::vector<vec::Box> boxes(model.bodies.size());
  std::vector<Vec3d> x(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = start_of(model, i);
    boxes[static_cast<std::size_t>(points.body[i])].extend(x[i]);
  }
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::unique_ptr<SurfaceDistance> surface;
    double deepest = 0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (static_cast<std::size_t>(points.body[i]) == b || boxes[b].distance2(x[i]) > 0) continue;
      if (surface == nullptr) surface = std::make_unique<SurfaceDistance>(surface_at_start(model, b));
      const double depth = -surface->signed_distance(x[i]);
      if (depth <= deepest) continue;
      deepest = depth;
      where = i;
    }
    if (deepest <= allowed) continue;
    throw Error(
        ErrorCode::bad_input,
        fmt::format("/contact: body '{}' begins inside body '{}', {:.3g} m deep at [{:.4g}, {:.4g}, {:.4g}]; expected at most "
                    "{:.3g} m (a quarter of a cell): bodies that touch need room",
                    model.bodies[static_cast<std::size_t>(points.body[where])].name, model.bodies[b].name, deepest, x[where][0],
                    x[where][1], x[where][2], allowed));
  }
}

}  // namespace pliant
