#include "render/link_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/vec.h"
#include "simulation/measure/energy.h"

namespace pliant::render {
namespace {

constexpr int kSides = 8;
constexpr double kThin = 0.003;  ///< radius of a spring in sizes of the scene

double size_of(const Model& model) {
  vec::Box box;
  for (const ModelBody& body : model.bodies) {
    for (const Vec3d& x : body.rest) box.extend(x);
  }
  return vec::norm(vec::sub(box.upper, box.lower));
}

bool is_shown(const SpringBatch& b) { return b.bars || b.join >= 0 || b.listed; }

Vec3d across(const Vec3d& axis) {
  const bool x_least = std::abs(axis[0]) <= std::abs(axis[1]) && std::abs(axis[0]) <= std::abs(axis[2]);
  const Vec3d other = x_least ? Vec3d{1, 0, 0} : std::abs(axis[1]) <= std::abs(axis[2]) ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d out = vec::cross(axis, other);
  return vec::mul(out, 1 / vec::norm(out));
}

/// Appends a prism from a to b with closed ends.
void append_prism(const Vec3d& a, const Vec3d& b, double radius, std::vector<float>& positions,
                  std::vector<std::int32_t>& triangles) {
  const Vec3d d = vec::sub(b, a);
  const double length = vec::norm(d);
  const Vec3d axis = length > 0 ? vec::mul(d, 1 / length) : Vec3d{0, 0, 1}, u = across(axis), v = vec::cross(axis, u);
  const auto first = static_cast<std::int32_t>(positions.size() / 3);
  const auto add = [&](const Vec3d& x) {
    for (const double c : x) positions.push_back(static_cast<float>(c));
  };
  for (const Vec3d& end : {a, b}) {
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      add(vec::add(end, vec::add(vec::mul(u, radius * std::cos(angle)), vec::mul(v, radius * std::sin(angle)))));
    }
  }
  for (int k = 0; k < kSides; ++k) {
    const std::int32_t p = first + k, q = first + (k + 1) % kSides;
    triangles.insert(triangles.end(), {p, q, q + kSides, p, q + kSides, p + kSides});
    if (k > 0 && k + 1 < kSides) triangles.insert(triangles.end(), {first, q, p, first + kSides, p + kSides, q + kSides});
  }
}

}  // namespace

void append_links(Simulation& simulation, std::vector<float>& positions, std::vector<std::int32_t>& triangles,
                  std::vector<std::int32_t>& bodies) {
  const Model& model = simulation.model();
  if (std::none_of(model.links.springs.begin(), model.links.springs.end(), is_shown)) return;
  std::vector<std::vector<Vec3d>> moved;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) moved.push_back(simulation.displacements(b));
  const std::vector<Vec3d> u = by_slot(model, moved);
  const LinkPoints& points = model.links.points;
  const double thin = kThin * size_of(model);
  const auto at = [&](std::int32_t p) {
    return vec::add(points.rest[p], points.value(p, [&](std::int32_t slot) { return u[static_cast<std::size_t>(slot)]; }));
  };
  for (const SpringBatch& batch : model.links.springs) {
    if (!is_shown(batch)) continue;
    const double radius = batch.bars ? batch.radius : thin;
    for (std::size_t s = 0; s < batch.size(); ++s) {
      const Vec3d a = at(batch.points[s][0]), b = batch.whole(s) ? at(batch.points[s][1]) : a;
      append_prism(a, b, batch.whole(s) ? radius : 0, positions, triangles);
    }
    bodies.resize(triangles.size() / 3, batch.bars ? kVesselBody : kSpringBody);
  }
}

}  // namespace pliant::render
