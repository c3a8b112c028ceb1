// Scenes to cut: boxes in memory, and what to measure of a simulation.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>

#include "backends/choice/backends.h"
#include "geometry/mesh.h"
#include "geometry/vec.h"
#include "simulation/simulation.h"

namespace pliant::cut_test {

/// A closed box from the origin to `size` [m].
inline std::shared_ptr<const TriangleMesh> box_surface(const Vec3d& size) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int a = 0; a < 8; ++a) {
    mesh->vertices.push_back({(a & 1) != 0 ? size[0] : 0, (a & 2) != 0 ? size[1] : 0, (a & 4) != 0 ? size[2] : 0});
  }
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Cells of 1 cm.
inline Body box_body(const std::string& name, const Vec3d& size, ElementKind element = ElementKind::hex8) {
  Body body;
  body.name = name;
  body.surface = name + ".obj";
  body.surface_in_memory = box_surface(size);
  body.lattice.spacing = 0.01;
  body.element = element;
  body.material.set_moduli(Law::neo_hookean, Moduli::from_lame(4000, 1000));
  body.material.density = 1000;
  body.pointer = "/bodies/0";
  body.model.pointer = "/bodies/0/model";
  return body;
}

/// Held beyond a plane, in the direction of its normal.
inline void hold(Body& body, const Vec3d& point, const Vec3d& normal) {
  Fixed fixed;
  fixed.where = {Selection::Kind::plane, point, normal, 0, {}, ""};
  body.fixed.push_back(fixed);
}

/// Moved there along a smooth curve.
inline void pull(Body& body, const Vec3d& point, const Vec3d& normal, const Vec3d& displacement, double duration) {
  Prescribed moved;
  moved.where = {Selection::Kind::plane, point, normal, 0, {}, ""};
  std::copy(displacement.begin(), displacement.end(), moved.displacement.begin());
  moved.curve.kind = Curve::Kind::smooth;
  moved.curve.duration = duration;
  body.prescribed.push_back(moved);
}

inline Scene scene_with(Body body) {
  Scene scene;
  scene.name = "cut";
  scene.bodies.push_back(std::move(body));
  return scene;
}

/// A square blade sweep in the plane x = `at` + lean y [m], far beyond any body here.
inline std::vector<SweepTriangle> wall(double at, double lean = 0) {
  return sweep({{{at - lean, -1, -1}, {at - lean, -1, 1}}}, {{{at + lean, 1, -1}, {at + lean, 1, 1}}});
}

inline Blade blade(const std::string& name, std::vector<std::array<double, 7>> path) {
  Blade out;
  out.name = name;
  out.path = std::move(path);
  return out;
}

inline double mass_of(const Simulation& s) {
  double mass = 0;
  for (std::size_t slot = 0; slot < s.model().mass.size(); ++slot) mass += s.model().own_mass(slot);
  return mass;
}

inline Vec3d momentum_of(const Simulation& s, bool with_added_inertia = false) {
  Vec3d sum{};
  for (std::size_t b = 0; b < s.model().bodies.size(); ++b) {
    const std::vector<Vec3d> v = s.velocities(b);
    for (std::size_t n = 0; n < v.size(); ++n) {
      const auto slot = static_cast<std::size_t>(s.model().bodies[b].slot[n]);
      sum = vec::add(sum, vec::mul(v[n], with_added_inertia ? s.model().mass[slot] : s.model().own_mass(slot)));
    }
  }
  return sum;
}

}  // namespace pliant::cut_test
