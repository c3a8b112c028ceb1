#include "simulation/contact/body_overlap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "geometry/distance.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Fraction of a body's surface that must lie on another body's surface for the two to count as duplicates.
constexpr double kSamePlace = 0.75;

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

/// Overlap of a body with another one: the depth of its deepest point, and the area of its surface on the other's.
struct Overlap {
  double deepest = 0;     ///< [m]
  std::size_t where = 0;  ///< index of this point
  double same = 0;        ///< area within `allowed` of surface with the same orientation [m^2]
};

void add_point(const ContactPoints& points, const SurfaceDistance& surface, const Vec3d& x, std::size_t i, double allowed,
               Overlap& found) {
  const ClosestPoint near = surface.closest(x);
  const auto& triangle = surface.mesh().triangles[static_cast<std::size_t>(near.triangle)];
  std::array<Vec3d, 3> corner;
  for (std::size_t a = 0; a < 3; ++a) corner[a] = surface.mesh().vertices[static_cast<std::size_t>(triangle[a])];
  const Vec3d normal = vec::cross(vec::sub(corner[1], corner[0]), vec::sub(corner[2], corner[0]));
  if (near.distance <= allowed && vec::dot(normal, points.normal[i]) > 0.5 * vec::norm(normal)) found.same += points.area[i];
  if (near.distance <= found.deepest || !surface.inside(x)) return;
  found.deepest = near.distance;
  found.where = i;
}

}  // namespace

void refuse_overlap(const Model& model, double allowed) {
  const ContactPoints& points = *model.contact;
  std::vector<vec::Box> boxes(model.bodies.size());
  std::vector<double> area(model.bodies.size());
  std::vector<Vec3d> x(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = start_of(model, i);
    boxes[static_cast<std::size_t>(points.body[i])].extend(x[i]);
    area[static_cast<std::size_t>(points.body[i])] += points.area[i];
  }
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::unique_ptr<SurfaceDistance> surface;
    std::vector<Overlap> of(boxes.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto body = static_cast<std::size_t>(points.body[i]);
      if (body == b || boxes[b].distance2(x[i]) > allowed * allowed) continue;
      if (surface == nullptr) surface = std::make_unique<SurfaceDistance>(surface_at_start(model, b));
      add_point(points, *surface, x[i], i, allowed, of[body]);
    }
    for (std::size_t a = 0; a < of.size(); ++a) {
      const std::string &name = model.bodies[a].name, &other = model.bodies[b].name;
      if (of[a].deepest > allowed) {
        const Vec3d& at = x[of[a].where];
        throw Error(ErrorCode::bad_input,
                    fmt::format("/contact: body '{}' begins inside body '{}', {:.3g} m deep at [{:.4g}, {:.4g}, {:.4g}]; "
                                "expected at most {:.3g} m (a quarter of a cell): bodies that touch need room",
                                name, other, of[a].deepest, at[0], at[1], at[2], allowed));
      }
      if (of[a].same > kSamePlace * area[a]) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("/contact: body '{}' begins in the same place as body '{}': {:.0f} % of its surface is nearer "
                                "than {:.3g} m (a quarter of a cell) to surface of the other that faces the same way; expected "
                                "separate bodies, or a scene without contact",
                                name, other, 100 * of[a].same / area[a], allowed));
      }
    }
  }
}

}  // namespace pliant
